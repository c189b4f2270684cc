#include "config/writer.hpp"

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <string_view>
#include <utility>
#include <variant>

#include "config/scalars.hpp"
#include "glocal/registry.hpp"

namespace glocal {
namespace {

std::string flow(const std::array<double, 2>& pair) {
  return "[" + to_yaml(pair[0]) + ", " + to_yaml(pair[1]) + "]";
}

template <class T>
std::string flow(const T& value) {
  return to_yaml(value);
}

template <class T>
std::string flow(const std::vector<T>& values) {
  std::string text;
  for (const T& value : values) text += (text.empty() ? "" : ", ") + flow(value);
  return "[" + text + "]";
}

/// Letters that mean nothing but themselves wherever a plain scalar may stand.
bool is_plain(const std::string& text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ||
           c == '-' || c == '+' || c == '.';
  });
}

class YamlWriter final : public ParamVisitor {
 public:
  using Comments = std::map<std::string, std::string>;

  /// `path` is that of the struct, with a dot behind it.
  YamlWriter(std::size_t indent, std::string path, const Comments& comments)
      : indent_(indent, ' '), path_(std::move(path)), comments_(comments) {}

  [[nodiscard]] const std::string& text() const { return text_; }

  void strategy(std::string_view name, StrategyChoice& choice, const RegistryBase& registry,
                const FieldInfo& /*info*/) override {
    YamlWriter parameters(indent_.size() + 4, path_below(name) + choice.name + ".", comments_);
    const bool left_open = !choice.params && registry.find(choice.name) != nullptr;
    const OwnedParams params = left_open ? registry.choose(choice.name).params : choice.params;
    if (params) params->visit(parameters);
    if (parameters.text_.empty()) {
      line(name, to_yaml(std::string_view(choice.name)));
    } else {
      text_ += indent_ + std::string(name) + ":\n" + indent_ + "  " + choice.name + ":\n" + parameters.text_;
    }
  }

 private:
  void plain(std::string_view name, ValueRef value, const FieldInfo& /*info*/) override {
    std::visit(
        [&]<class T>(const T* v) {
          // Variants are written as experiments of their own.
          if constexpr (!std::derived_from<T, Written>) {
            const auto comment = comments_.find(path_ + std::string(name));
            line(name, flow(*v) + (comment == comments_.end() ? "" : "  # " + comment->second));
          }
        },
        value);
  }

  void group(std::string_view name, AnyParams& params, const FieldInfo& /*info*/) override {
    YamlWriter fields(indent_.size() + 2, path_below(name), comments_);
    params.visit(fields);
    if (fields.text_.empty()) {
      line(name, "{}");
    } else {
      text_ += indent_ + std::string(name) + ":\n" + fields.text_;
    }
  }

  void list(std::string_view name, AnyList& list, const FieldInfo& /*info*/) override {
    if (list.size() == 0) {
      line(name, "[]");
      return;
    }
    text_ += indent_ + std::string(name) + ":\n";
    for (std::size_t i = 0; i < list.size(); ++i) text_ += item(list, i);
  }

  /// A list's item: its fields, the first of them behind a dash.
  [[nodiscard]] std::string item(AnyList& list, std::size_t i) const {
    static const Comments none;
    YamlWriter fields(indent_.size() + 4, "", none);
    list.visit(i, fields);
    const std::string dash = indent_ + "  - ";
    return fields.text_.empty() ? dash + "{}\n" : dash + fields.text_.substr(dash.size());
  }

  [[nodiscard]] std::string path_below(std::string_view name) const {
    return path_ + std::string(name) + ".";
  }

  void line(std::string_view name, const std::string& value) {
    text_ += indent_ + std::string(name) + ": " + value + "\n";
  }

  std::string indent_, path_;
  const Comments& comments_;
  std::string text_;
};

}  // namespace

std::string flow_yaml(const YamlNode& node) {
  std::string text;
  switch (node.kind) {
    case NodeKind::scalar:
      return !node.quoted && is_plain(node.text) ? node.text : to_yaml(std::string_view(node.text));
    case NodeKind::list:
      for (const YamlNode& item : node.items) text += (text.empty() ? "" : ", ") + flow_yaml(item);
      return "[" + text + "]";
    case NodeKind::map:
      for (const YamlEntry& entry : node.entries) {
        text +=
            (text.empty() ? "" : ", ") + to_yaml(std::string_view(entry.key)) + ": " + flow_yaml(entry.value);
      }
      return "{" + text + "}";
    case NodeKind::null:
    case NodeKind::invalid:
      break;
  }
  return "null";
}

std::string write_yaml(AnyParams& params, const std::map<std::string, std::string>& comments) {
  YamlWriter writer(0, "", comments);
  params.visit(writer);
  return writer.text();
}

}  // namespace glocal
