#include "config/reference.hpp"

#include <fmt/format.h>

#include <string_view>

#include "config/experiment_params.hpp"
#include "config/field_docs.hpp"

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

void write_rows(const StructDoc& doc, const std::string& prefix, std::string& rows, std::string& rules) {
  for (const FieldDoc& field : doc.fields) {
    const std::string key = prefix + field.name;
    const std::string value = default_text(field);
    rows += fmt::format("| `{}` | {} | {} | {} | {} |\n", key, cell(type_name(field)),
                        field.info.required ? "required" : code(value), cell(allowed_text(field)),
                        cell(field.info.doc.text));
    const std::string inner_prefix = key + (field.type == FieldType::list ? "[]." : ".");
    for (const StructDoc& inner : field.inner) write_rows(inner, inner_prefix, rows, rules);
  }
  for (const RuleDoc& rule : doc.rules) {
    const std::string subject =
        rule.field.empty() ? prefix.substr(0, prefix.size() - 1) : prefix + rule.field;
    rules += "- " + (subject.empty() ? "" : "`" + subject + "`: ") + rule.rule + ".\n";
  }
}

std::string table(const StructDoc& doc) {
  if (doc.fields.empty()) return "No parameters.\n";
  std::string rows;
  std::string rules;
  write_rows(doc, "", rows, rules);
  return "| key | type | default | allowed | meaning |\n|---|---|---|---|---|\n" + rows +
         (rules.empty() ? "" : "\nRules:\n\n" + rules);
}

}  // namespace

std::string parameter_reference(const Catalog& catalog) {
  ExperimentFileParams params(catalog);
  std::string text =
      "# Parameters\n\nWritten by `glocal reference` from the descriptions in the code; do not edit.\n\n"
      "## The experiment file\n\n" +
      table(document(params));
  for (const RegistryBase* registry : catalog.registries()) {
    text += "\n## " + registry->kind() + "\n";
    if (registry->all().empty()) text += "\nNone.\n";
    for (const StrategyInfo* info : registry->all()) {
      text += fmt::format("\n### {}\n\n{}\n\n{}", info->name, info->doc,
                          table(document(*info->default_params())));
    }
  }
  return text;
}

}  // namespace glocal
