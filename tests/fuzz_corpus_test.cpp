// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include "../fuzz/picture_round_trip.h"
#include "../fuzz/round_trip.h"
#include "orbitutte/io/file.h"

namespace orbitutte::fuzz_corpus_test {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> corpus(const std::string& format) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(fs::path(ORBITUTTE_SOURCE_DIR) / "fuzz/corpus" / format)) {
    files.push_back(entry.path());
  }
  return files;
}

class FuzzCorpus : public testing::TestWithParam<std::pair<std::string, MeshFormat>> {};

TEST_P(FuzzCorpus, IsReadAndComesBackOrIsRefusedInOneSentence) {
  const auto& [name, format] = GetParam();
  const std::vector<fs::path> files = corpus(name);
  EXPECT_FALSE(files.empty());
  for (const fs::path& file : files) {
    EXPECT_NO_THROW(fuzz::check_round_trip(read_file(file.string()), format)) << file;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Formats, FuzzCorpus,
    testing::Values(std::pair{"obj", MeshFormat::obj}, std::pair{"off", MeshFormat::off},
                    std::pair{"ply", MeshFormat::ply}, std::pair{"stl", MeshFormat::stl},
                    std::pair{"gifti", MeshFormat::gifti}, std::pair{"freesurfer", MeshFormat::freesurfer},
                    std::pair{"vtk", MeshFormat::vtk}, std::pair{"vtp", MeshFormat::vtp},
                    std::pair{"gltf", MeshFormat::gltf}, std::pair{"gltf", MeshFormat::glb}),
    [](const auto& test) { return test.param.first + std::to_string(static_cast<int>(test.param.second)); });

class ValuesFuzzCorpus : public testing::TestWithParam<std::pair<std::string, VertexDataFormat>> {};

TEST_P(ValuesFuzzCorpus, IsReadAndComesBackOrIsRefusedInOneSentence) {
  const auto& [name, format] = GetParam();
  const std::vector<fs::path> files = corpus(name);
  EXPECT_FALSE(files.empty());
  for (const fs::path& file : files) {
    EXPECT_NO_THROW(fuzz::check_value_round_trip(read_file(file.string()), format)) << file;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Formats, ValuesFuzzCorpus,
    testing::Values(std::pair{"curv", VertexDataFormat::curv}, std::pair{"annot", VertexDataFormat::annot},
                    std::pair{"npy", VertexDataFormat::npy}, std::pair{"values_text", VertexDataFormat::csv},
                    std::pair{"values_text", VertexDataFormat::text},
                    std::pair{"values_gifti", VertexDataFormat::shape_gifti},
                    std::pair{"values_gifti", VertexDataFormat::func_gifti},
                    std::pair{"values_gifti", VertexDataFormat::label_gifti}),
    [](const auto& test) { return test.param.first + std::to_string(static_cast<int>(test.param.second)); });

TEST(PictureFuzzCorpus, IsReadAndComesBackOrIsRefusedInOneSentence) {
  const std::vector<fs::path> files = corpus("png");
  EXPECT_FALSE(files.empty());
  for (const fs::path& file : files) {
    EXPECT_NO_THROW(fuzz::check_picture_round_trip(read_file(file.string()))) << file;
  }
}

}  // namespace
}  // namespace orbitutte::fuzz_corpus_test
