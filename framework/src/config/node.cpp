#include "config/node.hpp"

namespace glocal {

std::size_t count_nodes(const YamlNode& node) {
  std::size_t n = 1;
  for (const YamlNode& item : node.items) n += count_nodes(item);
  for (const YamlEntry& entry : node.entries) n += count_nodes(entry.value);
  return n;
}

std::string name_of(const YamlNode& node) {
  switch (node.kind) {
    case NodeKind::scalar:
      return (node.quoted ? "the text '" : "'") + node.text + "'";
    case NodeKind::list:
      return "a list";
    case NodeKind::map:
      return "a map";
    case NodeKind::null:
    case NodeKind::invalid:
      break;
  }
  return "nothing";
}

}  // namespace glocal
