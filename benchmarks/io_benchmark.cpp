// SPDX-License-Identifier: MIT
// Times the work on files, on one core: mesh files of every format, the embedding's file and the digest of
// the report. Prints one JSON row per file and direction; seconds are the median of the repetitions.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <iostream>
#include <nlohmann/json.hpp>
#include <numeric>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "orbitutte/io/file.h"
#include "orbitutte/io/mesh_io.h"
#include "orbitutte/orbifold/signature.h"
#include "orbitutte/report/embedding_file.h"
#include "orbitutte/report/report.h"
#include "orbitutte/samples/sample.h"

namespace {

using namespace orbitutte;
namespace fs = std::filesystem;

struct Arguments {
  int faces = 1600000;
  int repetitions = 5;
};

// An empty folder, removed at the end of its scope.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / ("orbitutte-io-" + std::string(6, 'X'))).string();
    if (::mkdtemp(name.data()) == nullptr) throw FileError(name + ": cannot be created");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::string path(const std::string& name) const { return (path_ / name).string(); }

 private:
  fs::path path_;
};

// Makes the next step pay for the pages that it touches, as the first work of a program does.
void give_back_freed_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

double median_seconds(int repetitions, const std::function<void()>& step) {
  std::vector<double> seconds;
  for (int k = 0; k < repetitions; ++k) {
    give_back_freed_memory();
    const auto start = std::chrono::steady_clock::now();
    step();
    seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  std::nth_element(seconds.begin(), seconds.begin() + repetitions / 2, seconds.end());
  return seconds[repetitions / 2];
}

class Table {
 public:
  Table(int faces, int repetitions) : faces_(faces), repetitions_(repetitions) {}

  /// Prints the row of a step; the size is that of the file, which exists once the step has run.
  void row(const char* direction, const std::string& path, const std::function<void()>& step) const {
    const double seconds = median_seconds(repetitions_, step);
    const auto bytes = fs::file_size(path);
    const nlohmann::ordered_json row = {
        {"faces", faces_},        {"file", fs::path(path).filename()},
        {"direction", direction}, {"bytes", bytes},
        {"seconds", seconds},     {"MB_per_second", 1e-6 * static_cast<double>(bytes) / seconds}};
    std::cout << row.dump() << std::endl;
  }

 private:
  int faces_, repetitions_;
};

// An embedding as large as that of the mesh. Its contents do not affect the time to write it.
Embedding like_an_embedding(const Mesh& mesh) {
  Embedding embedding;
  embedding.target = parse_orbifold("432");
  embedding.positions = mesh.V.rowwise().normalized();
  embedding.triangles = mesh.F;
  embedding.source_vertex.resize(mesh.V.rows());
  std::iota(embedding.source_vertex.begin(), embedding.source_vertex.end(), 0);
  return embedding;
}

void measure_meshes(const Table& table, const TemporaryFolder& folder, const Mesh& mesh) {
  for (const char* name : {"mesh.obj", "mesh.off", "mesh.ply", "mesh.stl"}) {
    const std::string path = folder.path(name);
    table.row("write", path, [&] { write_mesh(path, mesh); });
    table.row("read", path, [&] { to_triangle_mesh(read_mesh(path)); });
    const std::string bytes = read_file(path);
    table.row("sha256", path, [&] { sha256(bytes); });
  }
}

void measure_embedding(const Table& table, const TemporaryFolder& folder, const Embedding& embedding) {
  const std::string path = folder.path("embedding.ply");
  table.row("write", path, [&] { write_file(path, serialize_embedding(embedding)); });
  table.row("serialize", path, [&] { serialize_embedding(embedding); });
  table.row("read", path, [&] { read_embedding(path); });
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app{"Times reading, writing and hashing files of a sample mesh"};
  app.add_option("faces", arguments.faces, "Faces of the mesh")->capture_default_str();
  app.add_option("--repeat", arguments.repetitions, "Repetitions")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  try {
    const Mesh mesh = sample_mesh({SampleShape::figure, arguments.faces});
    const TemporaryFolder folder;
    const Table table(static_cast<int>(mesh.F.rows()), arguments.repetitions);
    measure_meshes(table, folder, mesh);
    measure_embedding(table, folder, like_an_embedding(mesh));
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
