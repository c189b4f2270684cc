#include "config/node.hpp"

namespace glocal {

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
