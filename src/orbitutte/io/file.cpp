// SPDX-License-Identifier: MIT
#include "orbitutte/io/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "orbitutte/types.h"

namespace orbitutte {

namespace fs = std::filesystem;

namespace {

/// Throws FileError with the reason in errno.
[[noreturn]] void refuse(const std::string& path, std::string_view problem) {
  throw FileError(fmt::format("{}: {}: {}", path, problem, std::generic_category().message(errno)));
}

constexpr mode_t readable_and_writable = 0666;  // the user's umask takes away from it
constexpr std::string_view cannot_read = "cannot be read";
constexpr std::string_view cannot_write = "cannot be written";

/// An open file, closed at the end of its scope.
class OpenFile {
 public:
  explicit OpenFile(int descriptor) : descriptor_(descriptor) {}
  OpenFile(const std::string& path, int flags)
      : OpenFile(::open(path.c_str(), flags | O_CLOEXEC, readable_and_writable)) {}
  OpenFile(OpenFile&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  OpenFile& operator=(OpenFile&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }
  ~OpenFile() {
    if (is_open()) ::close(descriptor_);
  }

  bool is_open() const { return descriptor_ >= 0; }
  int descriptor() const { return descriptor_; }

  /// Closes now, since some file systems report a full disk only here.
  bool close() { return ::close(std::exchange(descriptor_, -1)) == 0; }

 private:
  int descriptor_;
};

/// Nothing if nothing is at the path.
std::optional<struct stat> status(const std::string& path) {
  struct stat result;
  if (::stat(path.c_str(), &result) == 0) return result;
  if (errno != ENOENT) refuse(path, cannot_write);
  return std::nullopt;
}

std::size_t expected_size(const OpenFile& file) {
  struct stat result;
  const bool known = ::fstat(file.descriptor(), &result) == 0 && S_ISREG(result.st_mode);
  return known ? static_cast<std::size_t>(result.st_size) : 0;
}

bool write_all(const OpenFile& file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file.descriptor(), bytes.data(), bytes.size());
    if (written >= 0) {
      bytes.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno != EINTR) {
      return false;
    }
  }
  return true;
}

/// The path that a chain of symbolic links leads to, whether or not something is there. The chain has an
/// end, since `status` has followed it.
std::string link_target(const std::string& path) {
  fs::path target = path;
  std::error_code error;
  while (fs::is_symlink(target, error)) target = target.parent_path() / fs::read_symlink(target, error);
  return target.string();
}

void write_directly(const std::string& path, std::string_view bytes) {
  // Opening /dev/stdout anew would start at the front of the file that standard output may be redirected to.
  OpenFile file = path == "/dev/stdout" ? OpenFile(::dup(STDOUT_FILENO)) : OpenFile(path, O_WRONLY);
  if (!file.is_open() || !write_all(file, bytes) || !file.close()) refuse(path, cannot_write);
}

/// A path in the folder of `path` that no other process or thread writes to.
std::string temporary_beside(const std::string& path) {
  static std::atomic<unsigned> counter = 0;
  return (fs::path(path).parent_path() / fmt::format(".orbitutte-{}-{}.tmp", ::getpid(), counter++)).string();
}

/// A new file beside `target`, which is removed at the end of its scope unless it has been renamed.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& target) : path_(temporary_beside(target)), file_(create()) {
    // A killed process of the same number may have left a file behind; it stays, and the next name is tried.
    while (!file_.is_open() && errno == EEXIST) {
      path_ = temporary_beside(target);
      file_ = create();
    }
    exists_ = file_.is_open();
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (exists_) ::unlink(path_.c_str());
  }

  OpenFile& file() { return file_; }

  bool rename_to(const std::string& target) {
    exists_ = ::rename(path_.c_str(), target.c_str()) != 0;
    return !exists_;
  }

 private:
  OpenFile create() const { return OpenFile(path_, O_WRONLY | O_CREAT | O_EXCL); }

  std::string path_;
  OpenFile file_;
  bool exists_ = false;
};

void replace_file(const std::string& path, const std::string& target, std::string_view bytes) {
  const auto existing = status(target);
  // Renaming would replace a file that its owner has protected against writing.
  if (existing && ::access(target.c_str(), W_OK) != 0) refuse(path, cannot_write);
  TemporaryFile temporary(target);
  if (!temporary.file().is_open()) refuse(path, cannot_write);
  if (existing) ::fchmod(temporary.file().descriptor(), existing->st_mode & 07777);
  if (!write_all(temporary.file(), bytes)) refuse(path, cannot_write);
  if (!temporary.file().close() || !temporary.rename_to(target)) refuse(path, cannot_write);
}

// `path` names the file in messages.
std::string read_all(const OpenFile& file, const std::string& path) {
  constexpr std::size_t smallest_step = 1 << 16;
  std::string bytes(expected_size(file) + 1, '\0');  // one more, to see the end without growing
  std::size_t size = 0;
  for (;;) {
    if (size == bytes.size()) bytes.resize(size + std::max(size, smallest_step));
    const ssize_t count = ::read(file.descriptor(), bytes.data() + size, bytes.size() - size);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) refuse(path, cannot_read);
    if (count == 0) break;
    size += static_cast<std::size_t>(count);
  }
  bytes.resize(size);
  return bytes;
}

}  // namespace

std::string read_file(const std::string& path) {
  const OpenFile file(path, O_RDONLY);
  if (!file.is_open()) refuse(path, cannot_read);
  return read_all(file, path);
}

std::string read_standard_input() {
  constexpr const char* name = "standard input";
  const OpenFile file(::dup(STDIN_FILENO));
  if (!file.is_open()) refuse(name, cannot_read);
  return read_all(file, name);
}

void write_file(const std::string& path, std::string_view bytes) {
  const auto existing = status(path);
  if (path == "/dev/stdout" || (existing && !S_ISREG(existing->st_mode))) {
    write_directly(path, bytes);
  } else {
    replace_file(path, link_target(path), bytes);
  }
}

std::string ending_of(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  for (char& c : ending) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return ending;
}

bool is_compressed(const std::string& path) { return ending_of(path) == ".gz"; }

std::string without_gz(const std::string& path) {
  return is_compressed(path) ? path.substr(0, path.size() - 3) : path;
}

}  // namespace orbitutte
