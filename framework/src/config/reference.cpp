#include "config/reference.hpp"

#include <fmt/format.h>

#include <map>
#include <string_view>
#include <vector>

#include "config/experiment_params.hpp"
#include "config/field_docs.hpp"
#include "config/nearest.hpp"

namespace glocal {
namespace {

/// Text for a table's cell.
std::string cell(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '|' || c == '<' || c == '*' || c == '_') result += '\\';
    result += c;
  }
  return result;
}

std::string code(const std::string& text) {
  return text.empty() ? "" : "`" + text + "`";
}

/// The rows of a struct's fields for everyone, and those for experts, with what is in them.
struct Rows {
  std::string everyone;
  std::string experts;
  std::string rules;
};

void write_rows(const StructDoc& doc, const std::string& prefix, bool within_experts, Rows& rows) {
  for (const FieldDoc& field : doc.fields) {
    const std::string key = prefix + field.name;
    const std::string value = default_text(field);
    const bool for_experts = within_experts || field.info.audience == Audience::expert;
    (for_experts ? rows.experts : rows.everyone) += fmt::format(
        "| `{}` | {} | {} | {} | {} |\n", key, cell(type_name(field)),
        field.info.required ? "required" : code(value), cell(allowed_text(field)), cell(field.info.doc.text));
    const std::string inner_prefix = key + (field.type == FieldType::list ? "[]." : ".");
    for (const StructDoc& inner : field.inner) write_rows(inner, inner_prefix, for_experts, rows);
  }
  for (const RuleDoc& rule : doc.rules) {
    const std::string subject =
        rule.field.empty() ? prefix.substr(0, prefix.size() - 1) : prefix + rule.field;
    rows.rules += "- " + (subject.empty() ? "" : "`" + subject + "`: ") + rule.rule + ".\n";
  }
}

std::string tune_first(const StructDoc& doc) {
  std::vector<std::string> names = to_tune(doc);
  for (std::string& name : names) name = code(name);
  return names.empty() ? "" : "Tune first: " + join(names) + ".\n\n";
}

std::string table(const StructDoc& doc) {
  if (doc.fields.empty()) return "No parameters.\n";
  constexpr const char* head = "| key | type | default | allowed | meaning |\n|---|---|---|---|---|\n";
  Rows rows;
  write_rows(doc, "", false, rows);
  std::string text = tune_first(doc);
  if (!rows.everyone.empty()) text += head + rows.everyone;
  if (!rows.experts.empty()) text += "\nFor experts:\n\n" + std::string(head) + rows.experts;
  return text + (rows.rules.empty() ? "" : "\nRules:\n\n" + rows.rules);
}

/// Links to headings, as GitHub names them: the second of two alike has "-1" at its end.
class Links {
 public:
  std::string to(const std::string& heading) {
    const std::size_t before = seen_[heading]++;
    return fmt::format("[{0}](#{0}{1})", heading, before > 0 ? fmt::format("-{}", before) : "");
  }

 private:
  std::map<std::string, std::size_t> seen_;
};

std::string contents(const Catalog& catalog) {
  std::string text = "- [The experiment file](#the-experiment-file)\n";
  Links links;
  for (const RegistryBase* registry : catalog.registries()) {
    std::vector<std::string> strategies;
    text += "- " + links.to(registry->kind());
    for (const StrategyInfo* info : registry->all()) strategies.push_back(links.to(info->name));
    text += (strategies.empty() ? "" : ": ") + join(strategies) + "\n";
  }
  return text;
}

}  // namespace

std::string parameter_reference(const Catalog& catalog) {
  ExperimentFileParams params(catalog);
  std::string text =
      "# Parameters\n\nWritten by `glocal reference` from the descriptions in the code; do not edit.\n\n" +
      contents(catalog) + "\n## The experiment file\n\n" + table(document(params));
  for (const RegistryBase* registry : catalog.registries()) {
    text += "\n## " + registry->kind() + "\n";
    if (registry->all().empty()) text += "\nNone.\n";
    for (const StrategyInfo* info : registry->all()) {
      text += fmt::format(
          "\n### {}\n\n{}\n\nStatus: {}.\n\n{}{}", info->name, info->doc, to_string(info->standing),
          info->motions == Motions{} ? "" : fmt::format("Motions: {}.\n\n", to_string(info->motions)),
          table(document(*info->default_params())));
    }
  }
  return text;
}

}  // namespace glocal
