// SPDX-License-Identifier: MIT
#include "orbitutte/io/xml.h"

#include <expat.h>
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <new>
#include <type_traits>

#include "orbitutte/io/text_scanner.h"
#include "orbitutte/types.h"

namespace orbitutte {
namespace {

struct FreeXmlParser {
  void operator()(XML_Parser parser) const { XML_ParserFree(parser); }
};

// Nothing is thrown through the parser, which is C: what fails in a reader is memory alone, and is thrown
// afterwards.
class XmlParse {
 public:
  explicit XmlParse(XmlReader& reader) : reader_(reader), parser_(XML_ParserCreate(nullptr)) {
    if (!parser_) throw std::bad_alloc();
    XML_SetUserData(parser_.get(), this);
    XML_SetElementHandler(parser_.get(), on_begin, on_end);
    XML_SetCharacterDataHandler(parser_.get(), on_text);
  }

  void run(std::string_view bytes) {
    constexpr std::size_t part = 1 << 24;
    do {
      const std::string_view next = bytes.substr(0, part);
      bytes.remove_prefix(next.size());
      const int size = static_cast<int>(next.size());
      if (XML_Parse(parser_.get(), next.data(), size, bytes.empty()) == XML_STATUS_ERROR) refuse();
    } while (!bytes.empty());
  }

 private:
  [[noreturn]] void refuse() const {
    if (ran_out_of_memory_) throw std::bad_alloc();
    throw MeshError(fmt::format("line {}: the file is no XML: {}; export it again",
                                XML_GetCurrentLineNumber(parser_.get()),
                                XML_ErrorString(XML_GetErrorCode(parser_.get()))));
  }

  template <class Step>
  void guarded(const Step& step) {
    try {
      step();
    } catch (const std::bad_alloc&) {
      ran_out_of_memory_ = true;
      XML_StopParser(parser_.get(), XML_FALSE);
    }
  }

  static void on_begin(void* self, const char* element, const char** attributes) {
    auto& parse = *static_cast<XmlParse*>(self);
    parse.guarded([&] { parse.reader_.begin(element, XmlAttributes(attributes)); });
  }
  static void on_end(void* self, const char* element) {
    auto& parse = *static_cast<XmlParse*>(self);
    parse.guarded([&] { parse.reader_.end(element); });
  }
  static void on_text(void* self, const char* text, int length) {
    auto& parse = *static_cast<XmlParse*>(self);
    parse.guarded([&] { parse.reader_.text({text, static_cast<std::size_t>(length)}); });
  }

  XmlReader& reader_;
  std::unique_ptr<std::remove_pointer_t<XML_Parser>, FreeXmlParser> parser_;
  bool ran_out_of_memory_ = false;
};

// The number of bytes of the UTF-8 character that the text begins with, if XML allows it; otherwise 0.
std::size_t xml_character(std::string_view text) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  if (byte(0) < 0x80) return byte(0) >= ' ' || byte(0) == '\t' || byte(0) == '\n' || byte(0) == '\r' ? 1 : 0;
  const std::size_t size = byte(0) >= 0xF0 ? 4 : byte(0) >= 0xE0 ? 3 : 2;
  if (byte(0) < 0xC2 || byte(0) > 0xF4 || text.size() < size) return 0;
  unsigned code = byte(0) & (0xFFU >> (size + 1));
  for (std::size_t k = 1; k < size; ++k) {
    if ((byte(k) & 0xC0U) != 0x80U) return 0;
    code = code << 6U | (byte(k) & 0x3FU);
  }
  const unsigned least = size == 4 ? 0x10000 : size == 3 ? 0x800 : 0x80;
  const bool is_surrogate = code >= 0xD800 && code <= 0xDFFF;
  return code < least || code > 0x10FFFF || is_surrogate || code == 0xFFFE || code == 0xFFFF ? 0 : size;
}

}  // namespace

std::string XmlAttributes::operator[](std::string_view name) const {
  for (const char** at = list_; *at; at += 2)
    if (name == at[0]) return at[1];
  return {};
}

int XmlAttributes::number(std::string_view name) const {
  int value = 0;
  return parse_number((*this)[name], value) == NumberError::none ? value : 0;
}

double XmlAttributes::number(std::string_view name, double otherwise) const {
  double value = 0;
  return parse_number((*this)[name], value) == NumberError::none ? value : otherwise;
}

void read_xml(std::string_view bytes, XmlReader& reader) { XmlParse(reader).run(bytes); }

std::string xml_text(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const std::size_t size = xml_character(text);
    const char c = text.front();
    if (size == 0) {
      result += '?';
    } else if (c == '&' || c == '<' || c == '>' || c == '"' || c == '\r') {
      result += fmt::format("&#{};", static_cast<int>(c));
    } else {
      result += text.substr(0, size);
    }
    text.remove_prefix(std::max<std::size_t>(size, 1));
  }
  return result;
}

}  // namespace orbitutte
