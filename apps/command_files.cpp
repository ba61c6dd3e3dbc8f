// SPDX-License-Identifier: MIT
#include "command_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "orbitutte/errors.h"
#include "orbitutte/io/file.h"
#include "orbitutte/io/mesh_io.h"
#include "orbitutte/names.h"

namespace orbitutte::cli {
namespace {

namespace fs = std::filesystem;

// The path without links, dots and repeated slashes. A link may lead to a file that does not exist yet.
fs::path resolved(fs::path path) {
  constexpr int longest_chain = 40;  // as Linux has it
  std::error_code error;
  for (int k = 0; k < longest_chain && fs::is_symlink(path, error); ++k)
    path = path.parent_path() / fs::read_symlink(path, error);
  const fs::path absolute = fs::absolute(path, error);
  const fs::path canonical = fs::weakly_canonical(absolute, error);
  return error ? absolute.lexically_normal() : canonical;
}

// Is something there that cannot be overwritten, such as a pipe or /dev/null?
bool is_stream(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  return fs::is_character_file(status) || fs::is_fifo(status) || fs::is_socket(status);
}

void require_right_ending(const OutputFile& output) {
  const std::vector<std::string>& endings = output.endings;
  const std::string name = output.may_be_compressed ? without_gz(output.path) : output.path;
  if (std::find(endings.begin(), endings.end(), ending_of(name)) != endings.end()) return;
  throw ArgumentError(fmt::format("{} is '{}', but {} is written as {}; change the ending of the name",
                                  output.option, output.path, output.content, output.listed_endings()));
}

void require_inputs_kept(const OutputFile& output, const std::vector<InputFile>& inputs) {
  for (const InputFile& input : inputs)
    if (is_same_file(output.path, input.path))
      throw ArgumentError(fmt::format("{} is '{}', which is {} that the command reads; name another file",
                                      output.option, output.path, input.content));
}

}  // namespace

std::string OutputFile::listed_endings() const {
  return listed_choices(endings) + (may_be_compressed ? ", each also with .gz" : "");
}

bool is_same_file(const std::string& first, const std::string& second) {
  std::error_code error;
  return fs::equivalent(first, second, error) || resolved(first) == resolved(second);
}

void require_sound_files(const std::vector<InputFile>& inputs, const std::vector<OutputFile>& outputs) {
  for (auto output = outputs.begin(); output != outputs.end(); ++output) {
    if (is_stream(output->path)) continue;
    require_inputs_kept(*output, inputs);
    for (auto other = outputs.begin(); other != output; ++other)
      if (is_same_file(output->path, other->path))
        throw ArgumentError(fmt::format("{} and {} are both '{}'; give each a file of its own", other->option,
                                        output->option, output->path));
    require_right_ending(*output);
  }
}

void require_folders(const std::vector<OutputFile>& outputs, const std::string& made) {
  for (const OutputFile& output : outputs) {
    const fs::path folder = fs::path(output.path).parent_path();
    std::error_code error;
    if (folder.empty() || fs::is_directory(folder, error) ||
        (!made.empty() && resolved(folder) == resolved(made)))
      continue;
    throw FileError(fmt::format("{} is '{}', but there is no folder '{}'; make it first", output.option,
                                output.path, folder.string()));
  }
}

void require_no_file_there(const std::string& folder) {
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error))
    throw FileError(fmt::format("the folder '{}' cannot be made: a file has that name", folder));
}

void make_folder(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (fs::is_directory(folder)) return;
  throw FileError(fmt::format("the folder '{}' cannot be made: {}", folder,
                              error ? error.message() : "a file has that name"));
}

}  // namespace orbitutte::cli
