// SPDX-License-Identifier: MIT
// The files that a command reads and writes. Before any command reads anything, one rule is checked: an
// output replaces neither an input nor another output, and its name has the ending of its content.
#pragma once

#include <string>
#include <vector>

namespace orbitutte::cli {

/// A file that a command reads.
struct InputFile {
  /// "the mesh", for messages.
  std::string content;
  std::string path;
};

/// A file that a command writes.
struct OutputFile {
  /// "-o" or "--report", for messages.
  std::string option;
  /// "the embedding", for messages.
  std::string content;
  std::string path;
  /// The endings that its name may have, in lower case with the dot.
  std::vector<std::string> endings;
  /// May `.gz` follow them? Then the file is compressed.
  bool may_be_compressed = false;

  /// ".obj, .off or .ply", for messages and help.
  std::string listed_endings() const;
};

/// Do both paths lead to one file? Links of both kinds are followed, and neither file has to exist.
bool is_same_file(const std::string& first, const std::string& second);

/// Throws ArgumentError if an output is one of the inputs, if two outputs are one file, or if a name has an
/// ending that its content does not have. Devices and pipes may be anything. Opens no file.
void require_sound_files(const std::vector<InputFile>& inputs, const std::vector<OutputFile>& outputs);

/// Throws FileError if a file cannot be written since the folder that it goes into is none; files in `made`,
/// a folder that the command makes, have no such trouble. Opens no file.
void require_folders(const std::vector<OutputFile>& outputs, const std::string& made);

/// Throws FileError if there is a file with the name of a folder that is to be made.
void require_no_file_there(const std::string& folder);

/// Makes the folder, and those above it, if it is not there. Throws FileError.
void make_folder(const std::string& folder);

}  // namespace orbitutte::cli
