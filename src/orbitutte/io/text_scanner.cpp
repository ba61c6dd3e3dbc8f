// SPDX-License-Identifier: MIT
#include "orbitutte/io/text_scanner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "orbitutte/types.h"

namespace orbitutte {

namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }

bool is_line_end(char c) { return c == '\n' || c == '\r'; }

bool is_unprintable(char c) { return c < ' ' || c > '~'; }

std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view mark = "\xEF\xBB\xBF";
  return text.starts_with(mark) ? text.substr(mark.size()) : text;
}

}  // namespace

NumberError parse_tiny_number(std::string_view word, double& value) {
  // std::from_chars reports numbers that are too small like those that are too large.
  long double wide = 0;
  const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), wide);
  if (error != std::errc() || std::abs(wide) > 1) return NumberError::out_of_range;
  value = static_cast<double>(wide);
  return NumberError::none;
}

std::string shown(std::string_view word) {
  constexpr std::size_t longest = 40;
  std::string text(word.substr(0, longest));
  std::replace_if(text.begin(), text.end(), is_unprintable, '?');
  if (word.size() > longest) text += "...";
  return text;
}

std::string in_quotes(std::string_view word) { return fmt::format("'{}'", shown(word)); }

std::string shown(const TextItem& item) { return fmt::format("{} {}", shown(item.element), item.number); }

TextScanner::TextScanner(std::string_view text, Syntax syntax, int first_line)
    : syntax_(syntax), line_(first_line) {
  text = without_byte_order_mark(text);
  at_ = text.data();
  end_ = at_ + text.size();
  for (std::size_t k = 0; k < may_end_word_.size(); ++k) {
    const char c = static_cast<char>(k);
    may_end_word_[k] =
        is_blank(c) || is_line_end(c) || c == syntax.comment || (c == '\\' && syntax.backslash_continues);
  }
}

bool TextScanner::find_word() {
  while (!find_word_in_line()) {
    if (at_ == end_) return false;
    skip_line_break();
  }
  return true;
}

bool TextScanner::find_word_in_line() {
  while (at_ != end_ && !is_line_end(*at_)) {
    if (is_blank(*at_)) {
      ++at_;
    } else if (*at_ == syntax_.comment) {
      rest_of_line();
    } else if (!skip_continuation()) {
      return true;
    }
  }
  return false;
}

std::string_view TextScanner::word() {
  if (!find_word_in_line()) return {};
  const char* begin = at_;
  while (!at_word_end()) ++at_;
  return {begin, static_cast<std::size_t>(at_ - begin)};
}

void TextScanner::skip_words() {
  while (!word().empty()) {
  }
}

std::string_view TextScanner::rest_of_line() {
  const char* begin = at_;
  while (at_ != end_ && !is_line_end(*at_)) ++at_;
  return {begin, static_cast<std::size_t>(at_ - begin)};
}

bool TextScanner::at_continuation() const {
  return *at_ == '\\' && syntax_.backslash_continues && at_ + 1 != end_ && is_line_end(at_[1]);
}

bool TextScanner::skip_continuation() {
  if (!at_continuation()) return false;
  ++at_;
  skip_line_break();
  return true;
}

void TextScanner::skip_line_break() {
  const bool two_characters = *at_ == '\r' && at_ + 1 != end_ && at_[1] == '\n';
  at_ += two_characters ? 2 : 1;
  ++line_;
}

void TextScanner::refuse_number(NumberError error, bool is_integer, std::string_view text,
                                const TextItem& item, std::string_view what) const {
  if (text.empty()) {
    refuse(fmt::format("the line ends where {} needs another {}", shown(item), shown(what)));
  }
  const std::string_view why = error == NumberError::out_of_range ? "is out of range"
                               : is_integer                       ? "is not an integer"
                                                                  : "is not a number";
  refuse(fmt::format("{} has the {} {}, which {}", shown(item), shown(what), in_quotes(text), why));
}

void TextScanner::refuse(std::string_view problem) const {
  throw MeshError(fmt::format("line {}: {}; mend the file or export it again", line_, problem));
}

}  // namespace orbitutte
