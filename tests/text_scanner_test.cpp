// SPDX-License-Identifier: MIT
#include "orbitutte/io/text_scanner.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "orbitutte/types.h"

namespace orbitutte::text_scanner_test {
namespace {

constexpr TextScanner::Syntax syntax = {.comment = '#', .backslash_continues = true};

/// The next word as a number; none where it is refused.
template <class T>
std::optional<T> scanned(TextScanner& in) {
  try {
    return in.number<T>({"item", 0}, "number");
  } catch (const MeshError&) {
    return std::nullopt;
  }
}

template <class T>
std::optional<T> parsed(const std::string& word) {
  T value{};
  if (parse_number(word, value) != NumberError::none) return std::nullopt;
  return value;
}

/// Of the characters that numbers are made of, and some that spoil them. Often a number.
std::string number_like_word() {
  const std::string characters = "0123456789012345678901234567890+-..eEinfa/\\xg";
  return *rc::gen::nonEmpty(rc::gen::container<std::string>(rc::gen::elementOf(characters)));
}

/// Bits tell -0 from 0, and one NaN from another.
std::uint64_t bits(double number) { return std::bit_cast<std::uint64_t>(number); }

RC_GTEST_PROP(TextScannerProperty, ANumberIsTheWholeWordWhateverEndsIt, ()) {
  const std::string word = number_like_word();
  RC_PRE(word.back() != '\\');  // would join two lines
  const std::string end =
      *rc::gen::elementOf(std::vector<std::string>{"", " ", "\t", "\n", "\r", "#", "\\\n", " 7"});
  const std::string text = "  " + word + end;
  TextScanner in(text, syntax), integer_in(text, syntax);
  const std::optional<double> number = scanned<double>(in), expected = parsed<double>(word);
  RC_ASSERT(number.has_value() == expected.has_value());
  if (number) RC_ASSERT(bits(*number) == bits(*expected));
  RC_ASSERT(scanned<int>(integer_in) == parsed<int>(word));
  RC_ASSERT(in.bytes_left() == end.size());
  RC_ASSERT(integer_in.bytes_left() == end.size());
}

TEST(TextScanner, WhatIsNoPlainNumberIsNotTaken) {
  for (const std::string text : {"12/3 4", "+12", "1.5", "12a", "99999999999", "", "#12", "\\\n"}) {
    TextScanner in(text, syntax);
    int value = 0;
    EXPECT_FALSE(in.take_plain_number(value)) << text;
    EXPECT_EQ(in.word(), TextScanner(text, syntax).word()) << text;
  }
}

TEST(TextScanner, PlainNumbersAreTakenOneByOne) {
  TextScanner in("12 -3\\\n4#5\n6", syntax);
  int value = 0;
  for (const int expected : {12, -3, 4}) {
    EXPECT_TRUE(in.take_plain_number(value));
    EXPECT_EQ(value, expected);
  }
  EXPECT_FALSE(in.take_plain_number(value));
  EXPECT_EQ(in.line(), 2);
  EXPECT_TRUE(in.find_word());
  EXPECT_TRUE(in.take_plain_number(value));
  EXPECT_EQ(value, 6);
  EXPECT_EQ(in.line(), 3);
}

}  // namespace
}  // namespace orbitutte::text_scanner_test
