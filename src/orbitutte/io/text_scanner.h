// SPDX-License-Identifier: MIT
// The words and numbers of a text, read in place. Nothing is copied, the locale does not matter, and every
// complaint names the line.
#pragma once

#include <array>
#include <charconv>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>

namespace orbitutte {

enum class NumberError { none, malformed, out_of_range };

/// A number too small for a double, such as 1e-400, rounded to the nearest double.
NumberError parse_tiny_number(std::string_view word, double& value);

/// The number that is the whole of `word`. A leading '+' is accepted, and so are nan and inf if T is a
/// double.
template <class T>
NumberError parse_number(std::string_view word, T& value) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  const char* end = word.data() + word.size();
  const auto [rest, error] = std::from_chars(word.data(), end, value);
  if (error == std::errc::invalid_argument || rest != end) return NumberError::malformed;
  if (error == std::errc()) return NumberError::none;
  if constexpr (std::is_floating_point_v<T>) return parse_tiny_number(word, value);
  return NumberError::out_of_range;
}

/// The word as messages show it: printable ASCII, cut after forty characters.
std::string shown(std::string_view word);

/// The same in quotes.
std::string in_quotes(std::string_view word);

/// What a number of the text belongs to: {"face", 3}.
struct TextItem {
  std::string_view element;
  std::size_t number;
};

/// "face 3"
std::string shown(const TextItem& item);

/// Walks over a text word by word. Words are separated by blanks; '\n', "\r\n" and '\r' end a line.
class TextScanner {
 public:
  struct Syntax {
    /// Begins a comment, which lasts until the line ends; '\n': there are no comments.
    char comment = '\n';
    /// A backslash before a line break joins two lines.
    bool backslash_continues = false;
  };

  TextScanner(std::string_view text, Syntax syntax, int first_line = 1);

  /// Goes to the next word, in this line or a later one; false at the end of the text.
  bool find_word();

  /// Goes to the next word of this line; false at the end of the line.
  bool find_word_in_line();

  /// Takes the next word of this line; empty at the end of the line.
  std::string_view word();

  /// Takes the remaining words of this line, across continuations.
  void skip_words();

  /// Takes everything up to the next line break, comments and backslashes included.
  std::string_view rest_of_line();

  /// Takes the next word of this line if std::from_chars reads it as a number, as it does nearly always;
  /// otherwise takes nothing.
  template <class T>
  bool take_plain_number(T& value) {
    if (!find_word_in_line()) return false;
    const char* const begin = at_;
    const auto [rest, error] = std::from_chars(begin, end_, value);
    at_ = rest;
    if (error == std::errc() && at_word_end()) return true;
    at_ = begin;
    return false;
  }

  /// Takes the next word of this line, which must be a number: the `what` of `item`. Throws MeshError.
  template <class T>
  T number(const TextItem& item, std::string_view what) {
    T value{};
    if (take_plain_number(value)) return value;
    const std::string_view text = word();
    const NumberError error = parse_number(text, value);
    if (error != NumberError::none) refuse_number(error, std::is_integral_v<T>, text, item, what);
    return value;
  }

  /// Throws the MeshError that says why `text` is not the number `what` of `item`.
  [[noreturn]] void refuse_number(NumberError error, bool is_integer, std::string_view text,
                                  const TextItem& item, std::string_view what) const;

  /// Throws MeshError: "line 17: <problem>; mend the file or export it again".
  [[noreturn]] void refuse(std::string_view problem) const;

  int line() const { return line_; }
  std::size_t bytes_left() const { return static_cast<std::size_t>(end_ - at_); }

 private:
  bool at_word_end() const {
    if (at_ == end_) return true;
    if (!may_end_word_[static_cast<unsigned char>(*at_)]) return false;
    return *at_ != '\\' || at_continuation();
  }
  bool at_continuation() const;
  bool skip_continuation();
  void skip_line_break();

  const char* at_;
  const char* end_;
  Syntax syntax_;
  /// By character: blanks, ends of lines, the comment, a backslash that continues.
  std::array<bool, 256> may_end_word_;
  int line_;
};

}  // namespace orbitutte
