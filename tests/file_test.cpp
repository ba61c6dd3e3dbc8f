// SPDX-License-Identifier: MIT
#include "orbitutte/io/file.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "orbitutte/types.h"

namespace orbitutte::file_test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::EndsWith;
using testing::StartsWith;

/// A folder of its own for every test, removed at its end.
class File : public testing::Test {
 protected:
  File() {
    std::string name = (fs::temp_directory_path() / ("orbitutte-" + std::string(6, 'X'))).string();
    folder_ = ::mkdtemp(name.data());
  }
  ~File() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  std::vector<std::string> names() const {
    std::vector<std::string> result;
    for (const auto& entry : fs::directory_iterator(folder_))
      result.push_back(entry.path().filename().string());
    return result;
  }

  fs::path folder_;
};

template <class Action>
std::string refusal_by(Action action) {
  try {
    action();
  } catch (const FileError& error) {
    return error.what();
  }
  return "no FileError";
}

std::string any_bytes(std::size_t size) {
  std::string bytes(size, '\0');
  for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<char>(i * i >> 3);
  return bytes;
}

TEST_F(File, BytesComeBackWhatTheirNumber) {
  for (const std::size_t size : {0, 1, 4095, 4096, 65535, 65536, 65537, 1000000}) {
    write_file(path("bytes"), any_bytes(size));
    EXPECT_EQ(read_file(path("bytes")), any_bytes(size));
  }
}

RC_GTEST_PROP(FileProperty, AnyBytesComeBack, (const std::string& bytes)) {
  const std::string path =
      (fs::temp_directory_path() / ("orbitutte-bytes-" + std::to_string(::getpid()))).string();
  write_file(path, bytes);
  const std::string again = read_file(path);
  fs::remove(path);
  RC_ASSERT(again == bytes);
}

TEST_F(File, WritingLeavesNothingElseInTheFolder) {
  write_file(path("a"), "first");
  write_file(path("a"), "second");
  EXPECT_EQ(read_file(path("a")), "second");
  EXPECT_THAT(names(), testing::ElementsAre("a"));
}

TEST_F(File, WritingInTheWorkingFolderNeedsNoSlash) {
  const fs::path before = fs::current_path();
  fs::current_path(folder_);
  write_file("a", "bytes");
  fs::current_path(before);
  EXPECT_EQ(read_file(path("a")), "bytes");
}

TEST_F(File, ALongNameLeavesRoomForTheTemporaryFile) {
  const std::string name(255, 'n');
  write_file(path(name), "bytes");
  EXPECT_EQ(read_file(path(name)), "bytes");
}

TEST_F(File, AFailedWriteLeavesTheOldFileAndNothingElse) {
  fs::create_directory(path("folder"));
  EXPECT_THAT(refusal_by([&] { write_file(path("folder"), "bytes"); }), EndsWith("Is a directory"));
  EXPECT_THAT(names(), testing::ElementsAre("folder"));
}

TEST_F(File, AReplacedFileKeepsItsPermissions) {
  write_file(path("a"), "first");
  ::chmod(path("a").c_str(), 0640);
  write_file(path("a"), "second");
  struct stat status;
  ASSERT_EQ(::stat(path("a").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, mode_t{0640});
}

TEST_F(File, ANewFileIsReadableAsTheUmaskAllows) {
  const mode_t before = ::umask(022);
  write_file(path("a"), "bytes");
  ::umask(before);
  struct stat status;
  ASSERT_EQ(::stat(path("a").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, mode_t{0644});
}

TEST_F(File, SymbolicLinksAreWrittenThrough) {
  fs::create_directory(path("folder"));
  write_file(path("folder/target"), "first");
  fs::create_symlink("folder/target", path("link"));
  fs::create_symlink("link", path("link_to_link"));
  write_file(path("link_to_link"), "second");
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_TRUE(fs::is_symlink(path("link_to_link")));
  EXPECT_EQ(read_file(path("folder/target")), "second");
}

TEST_F(File, ALinkToNothingCreatesItsTarget) {
  fs::create_symlink("target", path("link"));
  write_file(path("link"), "bytes");
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_EQ(read_file(path("target")), "bytes");
}

TEST_F(File, LinksInACircleAreRefused) {
  fs::create_symlink("b", path("a"));
  fs::create_symlink("a", path("b"));
  EXPECT_THAT(refusal_by([&] { write_file(path("a"), "bytes"); }),
              StartsWith(path("a") + ": cannot be written"));
  EXPECT_TRUE(fs::is_symlink(path("a")));
}

TEST_F(File, APipeIsWrittenToAndStaysAPipe) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  const std::string bytes = any_bytes(300000);  // more than a pipe holds
  std::thread writer([&] { write_file(path("pipe"), bytes); });
  EXPECT_EQ(read_file(path("pipe")), bytes);
  writer.join();
  EXPECT_TRUE(fs::is_fifo(path("pipe")));
  EXPECT_THAT(names(), testing::ElementsAre("pipe"));
}

TEST_F(File, DevNullStaysADevice) {
  write_file("/dev/null", "bytes");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_EQ(read_file("/dev/null"), "");
}

TEST_F(File, StandardOutputIsContinuedWhereItStands) {
  const int before = ::dup(STDOUT_FILENO);
  const int file = ::open(path("output").c_str(), O_WRONLY | O_CREAT, 0600);
  ::fflush(stdout);
  ::dup2(file, STDOUT_FILENO);
  write_file("/dev/stdout", "one ");
  write_file("/dev/stdout", "two");
  ::dup2(before, STDOUT_FILENO);
  ::close(before);
  ::close(file);
  EXPECT_EQ(read_file(path("output")), "one two");
}

TEST_F(File, AFullDeviceIsReported) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  EXPECT_EQ(refusal_by([] { write_file("/dev/full", "bytes"); }),
            "/dev/full: cannot be written: No space left on device");
}

TEST_F(File, AMissingFileIsNamedWithTheSystemsReason) {
  EXPECT_EQ(refusal_by([&] { read_file(path("none")); }),
            path("none") + ": cannot be read: No such file or directory");
}

TEST_F(File, WhatIsWrongWithItsBytesIsSaidAfterItsPath) {
  write_file(path("a"), "bytes");
  EXPECT_EQ(parse_file(path("a"), [](const std::string& bytes) { return bytes.size(); }), 5u);
  const auto refuse = [](const std::string&) -> int { throw MeshError("line 1: no"); };
  EXPECT_EQ(refusal_by([&] { parse_file(path("none"), refuse); }),
            path("none") + ": cannot be read: No such file or directory");
  try {
    parse_file(path("a"), refuse);
    FAIL();
  } catch (const MeshError& error) {
    EXPECT_EQ(error.what(), path("a") + ": line 1: no");
  }
}

TEST(FileName, TheEndingIsInLowerCase) {
  EXPECT_EQ(ending_of("A Mesh.PLY"), ".ply");
  EXPECT_EQ(ending_of("folder.obj/a"), "");
  EXPECT_EQ(ending_of("a.b.Gz"), ".gz");
}

TEST_F(File, AFolderIsNoFileToRead) {
  EXPECT_EQ(refusal_by([&] { read_file(folder_.string()); }),
            folder_.string() + ": cannot be read: Is a directory");
}

TEST_F(File, AMissingFolderIsNamedWithTheSystemsReason) {
  EXPECT_EQ(refusal_by([&] { write_file(path("none/file"), "bytes"); }),
            path("none/file") + ": cannot be written: No such file or directory");
}

TEST_F(File, MissingPermissionsAreRespected) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may read and write everything";
  write_file(path("a"), "bytes");
  ::chmod(path("a").c_str(), 0);
  EXPECT_EQ(refusal_by([&] { read_file(path("a")); }), path("a") + ": cannot be read: Permission denied");
  EXPECT_EQ(refusal_by([&] { write_file(path("a"), "new"); }),
            path("a") + ": cannot be written: Permission denied");
}

TEST_F(File, ThreadsDoNotDisturbEachOther) {
  std::vector<std::thread> writers;
  for (int i = 0; i < 8; ++i) {
    writers.emplace_back([&, i] {
      for (int k = 0; k < 20; ++k) write_file(path("shared"), std::string(10000, static_cast<char>('a' + i)));
    });
  }
  for (std::thread& writer : writers) writer.join();
  const std::string bytes = read_file(path("shared"));
  EXPECT_EQ(bytes, std::string(10000, bytes[0]));
  EXPECT_THAT(names(), testing::ElementsAre("shared"));
}

}  // namespace
}  // namespace orbitutte::file_test
