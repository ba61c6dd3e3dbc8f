// SPDX-License-Identifier: MIT
// NumPy's files.
#include "orbitutte/io/numpy_array.h"

#include <gmock/gmock.h>

#include "orbitutte/errors.h"
#include "orbitutte/io/file.h"

namespace orbitutte::numpy_array_test {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

NumpyArray counted(std::vector<int> shape, bool is_whole) {
  NumpyArray array = {std::move(shape), {}, is_whole};
  int count = 1;
  for (const int size : array.shape) count *= size;
  for (int k = 0; k < count; ++k) array.values.push_back(is_whole ? k - 3 : k / 7.0);
  return array;
}

TEST(NumpyArrays, OfAnyShapeReadBack) {
  for (const std::vector<int>& shape : {std::vector<int>{}, {5}, {0}, {2, 3}, {6, 4, 4}, {2, 1, 3, 2}})
    for (const bool is_whole : {false, true}) {
      const NumpyArray array = counted(shape, is_whole),
                       again = parse_numpy_array(serialize_numpy_array(array));
      EXPECT_EQ(again.shape, array.shape);
      EXPECT_EQ(again.values, array.values);
      EXPECT_EQ(again.is_whole, is_whole);
    }
}

TEST(NumpyArrays, ThatAreCutShortAreRefused) {
  for (const std::vector<int>& shape : {std::vector<int>{}, {5}, {2, 3}}) {
    const std::string bytes = serialize_numpy_array(counted(shape, false));
    for (std::size_t size = 0; size < bytes.size(); ++size)
      EXPECT_THROW(parse_numpy_array(std::string_view(bytes).substr(0, size)), MeshError) << size;
  }
}

// "'fortran_order': False" becomes True, of the same length.
TEST(NumpyArrays, ByColumnsAreTransposed) {
  const NumpyArray array = counted({4, 3, 2}, false);
  std::string bytes = serialize_numpy_array(array);
  bytes.replace(bytes.find("False"), 5, "True ");
  bytes.replace(bytes.find("(4, 3, 2)"), 9, "(2, 3, 4)");
  const NumpyArray turned = parse_numpy_array(bytes);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 2; ++k)
        EXPECT_EQ(turned.values[(k * 3 + j) * 4 + i], array.values[(i * 3 + j) * 2 + k]);
}

TEST(NumpyArchives, ReadBack) {
  const NumpyArchive archive = {{"values", counted({3, 4}, false)}, {"index", counted({9}, true)}};
  const NumpyArchive again = parse_numpy_archive(serialize_numpy_archive(archive));
  ASSERT_EQ(again.size(), 2U);
  for (int k = 0; k < 2; ++k) {
    EXPECT_EQ(again[k].first, archive[k].first);
    EXPECT_EQ(again[k].second.values, archive[k].second.values);
    EXPECT_EQ(again[k].second.shape, archive[k].second.shape);
  }
}

// No byte may be lost or changed without a word, and none may make it read beyond the end.
TEST(NumpyArchives, ThatAreDamagedAreRefused) {
  const std::string bytes = serialize_numpy_archive({{"values", counted({3, 4}, false)}});
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_THROW(parse_numpy_archive(bytes.substr(0, size)), MeshError) << size;
  std::string changed = bytes;
  changed[bytes.find("<f8") + 140] ^= 1;  // of a number
  EXPECT_THAT([&] { parse_numpy_archive(changed); }, ThrowsMessage<MeshError>(HasSubstr("'values'")));
  for (std::size_t k = 0; k < bytes.size(); ++k) {
    changed = bytes;
    changed[k] = static_cast<char>(changed[k] ^ 0x55);
    try {
      parse_numpy_archive(changed);
    } catch (const MeshError&) {
      continue;  // as it should be, or a byte that means nothing here
    }
  }
}

std::string file_at(const std::string& path) {
  return read_file(std::string(ORBITUTTE_SOURCE_DIR) + "/" + path);
}

// numpy.savez_compressed(values=zeros((3, 4), float32), f=asfortranarray(arange(6).reshape(2, 3)))
TEST(NumpyArchives, ThatNumpyHasCompressedAreRead) {
  const NumpyArchive archive = parse_numpy_archive(file_at("fuzz/corpus/npz/packed.npz"));
  ASSERT_EQ(archive.size(), 2U);
  EXPECT_EQ(archive[0].first, "values");
  EXPECT_EQ(archive[0].second.shape, (std::vector<int>{3, 4}));
  EXPECT_FALSE(archive[0].second.is_whole);
  EXPECT_EQ(archive[1].second.values, (std::vector<double>{0, 1, 2, 3, 4, 5}));
  EXPECT_TRUE(archive[1].second.is_whole);
}

}  // namespace
}  // namespace orbitutte::numpy_array_test
