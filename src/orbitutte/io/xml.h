// SPDX-License-Identifier: MIT
// XML documents, element by element. External entities are never read.
#pragma once

#include <string>
#include <string_view>

namespace orbitutte {

/// The attributes of an element.
class XmlAttributes {
 public:
  /// Names and values in turn, ended by a null pointer.
  explicit XmlAttributes(const char** list) : list_(list) {}

  /// The value of an attribute; empty if it is missing.
  std::string operator[](std::string_view name) const;

  /// The same as a whole number; 0 if it is none.
  int number(std::string_view name) const;

  /// The same as a floating number; `otherwise` if it is none.
  double number(std::string_view name, double otherwise) const;

 private:
  const char** list_;
};

/// What a reader does with the parts of a document. It may throw std::bad_alloc alone.
class XmlReader {
 public:
  XmlReader() = default;
  XmlReader(const XmlReader&) = delete;
  XmlReader& operator=(const XmlReader&) = delete;
  virtual ~XmlReader() = default;

  virtual void begin(const std::string& element, const XmlAttributes& attributes) = 0;
  virtual void end(const std::string& element) = 0;

  /// A piece of the text between tags.
  virtual void text(std::string_view piece) = 0;
};

/// Tells the reader the parts of the document in their order. Throws MeshError naming the line that is no
/// XML.
void read_xml(std::string_view bytes, XmlReader& reader);

/// The text as it stands between tags: what XML gives a meaning is written as an entity, and what no document
/// can hold (control characters, bytes that are no UTF-8) as '?'.
std::string xml_text(std::string_view text);

}  // namespace orbitutte
