// SPDX-License-Identifier: MIT
#include "orbitutte/page/html_template.h"

#include <fmt/format.h>

#include <kainjow/mustache.hpp>
#include <unordered_map>

#include "orbitutte/export/html_text.h"
#include "orbitutte/types.h"

namespace orbitutte {
namespace {

using kainjow::mustache::data;
using kainjow::mustache::mustache;

data to_data(const Content& content) {
  if (content.is_boolean()) return data(content.get<bool>());
  if (content.is_string()) return data(content.get_ref<const std::string&>());
  if (content.is_array()) {
    kainjow::mustache::list list;
    for (const Content& element : content) list.push_back(to_data(element));
    return data(list);
  }
  if (!content.is_object()) throw ArgumentError("a template takes texts, booleans, lists and objects only");
  data object;
  for (const auto& [name, value] : content.items()) object[name] = to_data(value);
  return object;
}

/// The total length of the content's texts.
std::size_t length_of(const Content& content) {
  if (content.is_string()) return content.get_ref<const std::string&>().size();
  std::size_t length = 0;
  if (content.is_structured())
    for (const Content& part : content) length += length_of(part);
  return length;
}

/// Takes the text piece by piece: a stream would hold it twice.
struct Sink {
  std::string text;

  Sink& operator<<(const std::string& piece) {
    text += piece;
    return *this;
  }
};

/// The library shows nothing for names without content; here such names are an error.
class Names : public kainjow::mustache::context<std::string> {
 public:
  Names(const data& content, const Template& what) : context(&content), what_(what) {
    for (const auto& [name, text] : what.parts)
      parts_.emplace(name, kainjow::mustache::partial([&text = text] { return std::string(text); }));
  }

  const data* get(const std::string& name) const override {
    if (const data* const found = context::get(name)) return found;
    const auto known = others_.find(name);
    if (known != others_.end()) return &known->second;
    const std::optional<std::string> text = what_.otherwise ? what_.otherwise(name) : std::nullopt;
    if (!text) throw ArgumentError(fmt::format("the template's slot '{}' has no content", name));
    return &others_.emplace(name, data(*text)).first->second;
  }

  const data* get_partial(const std::string& name) const override {
    const auto part = parts_.find(name);
    if (part == parts_.end()) throw ArgumentError(fmt::format("the template has no part '{}'", name));
    return &part->second;
  }

 private:
  const Template& what_;
  std::unordered_map<std::string, data> parts_;
  mutable std::unordered_map<std::string, data> others_;
};

}  // namespace

std::string fill_template(const Template& what, const Content& content) {
  mustache engine{std::string(what.text)};
  engine.set_custom_escape([](const std::string& text) { return escape_html(text); });
  if (!engine.is_valid()) throw ArgumentError("the template: " + engine.error_message());
  const data all = to_data(content);
  Names names(all, what);
  Sink sink;
  sink.text.reserve(2 * what.text.size() + length_of(content));  // growing would copy long texts once more
  engine.render(names, sink);
  if (!engine.is_valid()) throw ArgumentError("the template: " + engine.error_message());
  return std::move(sink.text);
}

}  // namespace orbitutte
