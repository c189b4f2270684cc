#include "config/yaml_parser.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <array>
#include <sstream>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "config/text_file.hpp"
#include "glocal/words.hpp"

namespace glocal {
namespace {

constexpr std::size_t max_depth = 32;

/// Thrown to leave the parser once nothing more is to be learned from the text.
struct Stop {};

/// Whether text that begins with a quote has its other quote (text that begins otherwise needs none).
bool is_closed(std::string_view text) {
  const char quote = text.empty() ? '\0' : text.front();
  if (quote != '"' && quote != '\'') return true;
  for (std::size_t i = 1; i < text.size(); ++i) {
    const bool doubled = quote == '\'' && text.substr(i).starts_with("''");
    const bool escaped = quote == '"' && text[i] == '\\';
    if (doubled || escaped) {
      ++i;
    } else if (text[i] == quote) {
      return true;
    }
  }
  return false;
}

/// Builds the tree from yaml-cpp's events. (Its own tree keeps duplicate keys silently and forgets places.)
class TreeBuilder final : public YAML::EventHandler {
 public:
  TreeBuilder(std::string_view source, std::shared_ptr<const Origin> origin, bool with_lines,
              std::vector<Fault>& faults)
      : source_(source), origin_(std::move(origin)), with_lines_(with_lines), faults_(&faults) {}

  [[nodiscard]] std::optional<YamlNode> take_root() { return std::move(root_); }

  [[nodiscard]] Place place(const YAML::Mark& mark) const {
    if (!with_lines_ || mark.is_null()) return {origin_, 0, 0};
    return {origin_, mark.line + 1, mark.column + 1};
  }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (!root_) return;
    report(place(mark),
           "only one document is allowed, and another begins here (by '---', or by wrong indentation?)");
    throw Stop{};
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    refuse_anchor(mark, anchor);
    add(make_node(NodeKind::null, place(mark)));
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t /*anchor*/) override {
    report(place(mark), at_path("aliases are not supported; write the value out"));
    add(make_node(NodeKind::invalid, place(mark)));
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    refuse_anchor(mark, anchor);
    refuse_tag(mark, tag);
    if (tag == "!") check_quotes(mark);
    YamlNode node = make_scalar(place(mark), value);
    node.quoted = tag == "!";
    add(std::move(node));
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value /*style*/) override {
    start(mark, tag, anchor, NodeKind::list);
  }
  void OnSequenceEnd() override { finish(); }

  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value /*style*/) override {
    start(mark, tag, anchor, NodeKind::map);
  }
  void OnMapEnd() override { finish(); }

 private:
  /// A key that waits for its value; the value of a dropped key is forgotten.
  struct Key {
    std::string text;
    Place place;
    bool dropped = false;
  };
  struct Frame {
    YamlNode node;
    std::optional<Key> key;
    std::unordered_map<std::string, int> lines;  ///< Of the keys so far.
  };

  void start(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, NodeKind kind) {
    refuse_anchor(mark, anchor);
    refuse_tag(mark, tag);
    if (frames_.size() == max_depth) {
      report(place(mark), at_path("nested deeper than " + std::to_string(max_depth) + " levels"));
      throw Stop{};
    }
    frames_.push_back({make_node(kind, place(mark)), std::nullopt, {}});
  }

  void finish() {
    YamlNode node = std::move(frames_.back().node);
    frames_.pop_back();
    add(std::move(node));
  }

  void add(YamlNode node) {
    if (frames_.empty()) {
      root_ = std::move(node);
      return;
    }
    Frame& top = frames_.back();
    if (top.node.kind == NodeKind::list) {
      top.node.items.push_back(std::move(node));
    } else if (!top.key) {
      top.key = check_key(std::move(node));
    } else {
      const Key key = *std::exchange(top.key, std::nullopt);
      // yaml-cpp places what is not there at whatever comes next.
      if (node.kind == NodeKind::null) node.place = key.place;
      if (!key.dropped) top.node.entries.push_back({key.text, key.place, std::move(node)});
    }
  }

  Key check_key(YamlNode node) {
    Key key{std::move(node.text), node.place};
    if (node.kind != NodeKind::scalar) {
      key.dropped = true;
      if (node.kind != NodeKind::invalid) {
        report(key.place, at_path("a key must be a word, not " + name_of(node)));
      }
    } else if (key.text == "<<") {
      key.dropped = true;
      report(key.place, at_path("merge keys (<<) are not supported; write the keys out"));
    } else if (const auto [first, is_new] = frames_.back().lines.try_emplace(key.text, key.place.line);
               !is_new) {
      key.dropped = true;
      std::string where = first->second > 0 ? " (first in line " + std::to_string(first->second) + ")" : "";
      report(key.place, at_path("duplicate key '" + key.text + "'" + where));
    }
    return key;
  }

  void refuse_anchor(const YAML::Mark& mark, YAML::anchor_t anchor) {
    if (anchor != 0)
      report(place(mark), at_path("anchors are not supported; write the value out where it is needed"));
  }

  /// yaml-cpp gives "?" for plain scalars and collections, "!" for quoted scalars.
  void refuse_tag(const YAML::Mark& mark, const std::string& tag) {
    if (tag.empty() || tag == "?" || tag == "!") return;
    report(place(mark), at_path("tags are not supported; remove '" + tag + "'"));
  }

  /// yaml-cpp lets the end of the file close a quote, and takes the tag `!` for one.
  void check_quotes(const YAML::Mark& mark) {
    const std::string_view text = source_.substr(static_cast<std::size_t>(mark.pos));
    if (text.starts_with('!')) {
      report(place(mark), at_path("tags are not supported; remove '!'"));
    } else if (!is_closed(text)) {
      report(place(mark), "not valid YAML: the quote that begins here is not closed");
      throw Stop{};
    }
  }

  /// The message with the path of the collection it is found in.
  [[nodiscard]] std::string at_path(const std::string& message) const {
    std::string path;
    for (const Frame& frame : frames_) {
      if (frame.key) path += (path.empty() ? "" : ".") + frame.key->text;
      if (frame.node.kind == NodeKind::list) path += "[" + std::to_string(frame.node.items.size()) + "]";
    }
    return path.empty() ? message : path + ": " + message;
  }

  void report(const Place& where, std::string message) {
    faults_->push_back(fault_at(where, std::move(message)));
  }

  std::string_view source_;
  std::shared_ptr<const Origin> origin_;
  bool with_lines_;
  std::vector<Fault>* faults_;
  std::vector<Frame> frames_;
  std::optional<YamlNode> root_;
};

/// Whether a fault may come from a tab that its line begins with, perhaps behind the dash of a list: yaml-cpp
/// passes over it, and finds that keys and items do not stand where they should.
bool is_of_tab(const std::string& message, std::string_view source, const YAML::Mark& mark) {
  static const std::array<std::string_view, 5> rules = {
      YAML::ErrorMsg::END_OF_MAP, YAML::ErrorMsg::END_OF_SEQ, YAML::ErrorMsg::MAP_KEY,
      YAML::ErrorMsg::MAP_VALUE, YAML::ErrorMsg::BLOCK_ENTRY};
  if (mark.is_null() || std::ranges::find(rules, message) == rules.end()) return false;
  const std::string_view before = source.substr(0, static_cast<std::size_t>(mark.pos));
  const std::string_view line = before.substr(before.rfind('\n') + 1);
  return line.substr(0, line.find_first_not_of(" \t-")).find('\t') != std::string_view::npos;
}

/// yaml-cpp names the rule; this adds what to look for.
std::string hint(const std::string& message, std::string_view source, const YAML::Mark& mark) {
  using Hint = std::pair<std::string_view, std::string_view>;
  static const std::array<Hint, 9> hints{{
      {YAML::ErrorMsg::TAB_IN_INDENTATION, "indent with spaces"},
      {YAML::ErrorMsg::END_OF_MAP, "check the indentation here and above"},
      {YAML::ErrorMsg::END_OF_SEQ, "check the indentation here and above"},
      {YAML::ErrorMsg::END_OF_MAP_FLOW, "is a '}' or ',' missing?"},
      {YAML::ErrorMsg::END_OF_SEQ_FLOW, "is a ']' or ',' missing?"},
      {YAML::ErrorMsg::EOF_IN_SCALAR, "is a closing quote missing?"},
      {YAML::ErrorMsg::MAP_VALUE, "check the indentation, and quote text that has ': ' in it"},
      {YAML::ErrorMsg::UNKNOWN_TOKEN, "quote text that begins with a special character"},
      {YAML::ErrorMsg::FLOW_END, "brackets do not match"},
  }};
  if (is_of_tab(message, source, mark)) return " (a tab is no indentation; indent with spaces)";
  for (const auto& [rule, advice] : hints) {
    if (message == rule) return " (" + std::string(advice) + ")";
  }
  return "";
}

std::optional<YamlNode> parse(const std::string& text, const std::shared_ptr<const Origin>& origin,
                              bool with_lines, std::vector<Fault>& faults) {
  // Without the byte order mark, yaml-cpp's positions are those in the text.
  const std::string source(without_byte_order_mark(text));
  TreeBuilder builder(source, origin, with_lines, faults);
  try {
    std::istringstream stream(source);
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(builder)) {
    }
  } catch (const Stop&) {
    return std::nullopt;
  } catch (const YAML::Exception& error) {
    faults.push_back(fault_at(builder.place(error.mark),
                              "not valid YAML: " + error.msg + hint(error.msg, source, error.mark)));
    return std::nullopt;
  }
  return builder.take_root();
}

}  // namespace

std::optional<YamlNode> parse_yaml(const std::string& text, const std::shared_ptr<const Origin>& origin,
                                   std::vector<Fault>& faults) {
  if (auto binary = find_binary(text, *origin)) {
    faults.push_back(*std::move(binary));
    return std::nullopt;
  }
  const std::size_t before = faults.size();
  auto root = parse(text, origin, true, faults);
  const bool empty = !root || root->kind == NodeKind::null;
  if (empty && faults.size() == before) faults.push_back({origin->label, 0, 0, "the file is empty"});
  return empty ? std::nullopt : std::move(root);
}

std::optional<YamlNode> parse_yaml_value(const std::string& text, const std::shared_ptr<const Origin>& origin,
                                         std::vector<Fault>& faults) {
  if (auto binary = find_binary(text, *origin)) {
    faults.push_back({origin->label, 0, 0, "the value is not plain text"});
    return std::nullopt;
  }
  const std::size_t before = faults.size();
  auto root = parse(text, origin, false, faults);
  if (!root && faults.size() == before) root = make_node(NodeKind::null, {origin, 0, 0});
  return root;
}

}  // namespace glocal
