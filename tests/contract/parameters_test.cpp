// Every strategy says what it is, since when, and what its parameters are.
#include <gtest/gtest.h>

#include "config/field_docs.hpp"
#include "contract/strategies.hpp"

namespace glocal::test::parameters_test {
namespace {

void expect_documented(const StructDoc& doc) {
  for (const FieldDoc& field : doc.fields) {
    const std::string text = field.info.doc.text;
    EXPECT_GT(text.size(), 5U) << field.name;
    EXPECT_TRUE(text.ends_with('.') || text.ends_with("…")) << field.name << ": " << text;
    for (const StructDoc& inner : field.inner) expect_documented(inner);
  }
}

TEST_F(Contract, EveryStrategyAndParameterIsDocumented) {
  for (const RegistryBase* registry : std::as_const(catalog_).registries()) {
    for (const StrategyInfo* info : registry->all()) {
      SCOPED_TRACE(registry->kind() + " " + info->name);
      EXPECT_TRUE(info->doc.ends_with('.')) << info->doc;
      EXPECT_TRUE(info->origin.starts_with("glocal")) << info->origin;
      EXPECT_FALSE(info->standing.since.empty());
      expect_documented(document(*info->default_params()));
    }
  }
}

}  // namespace
}  // namespace glocal::test::parameters_test
