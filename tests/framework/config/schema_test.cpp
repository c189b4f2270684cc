// The schema accepts what the reader accepts, and refuses what it refuses, as far as a schema can.
#include "config/schema.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <string>

#include "framework/config/toy_catalog.hpp"

namespace glocal::test::schema_test {
namespace {

using Json = nlohmann::ordered_json;

/// The part of JSON Schema 2020-12 that the schema uses; other keywords fail the test.
class Validator {
 public:
  explicit Validator(Json root) : root_(std::move(root)) {}

  [[nodiscard]] bool accepts(const Json& value) const { return accepts(root_, value); }

 private:
  [[nodiscard]] bool accepts(const Json& schema, const Json& value) const {
    if (schema.is_boolean()) return schema.get<bool>();
    return std::all_of(schema.items().begin(), schema.items().end(),
                       [&](const auto& item) { return keyword(item.key(), item.value(), schema, value); });
  }

  [[nodiscard]] bool keyword(const std::string& key, const Json& rule, const Json& schema,
                             const Json& value) const {
    if (key == "$ref") return accepts(root_.at(Json::json_pointer(rule.get<std::string>().substr(1))), value);
    if (key == "type") return type(rule, value);
    if (key == "const") return value == rule;
    if (key == "enum") return std::find(rule.begin(), rule.end(), value) != rule.end();
    if (key == "not") return !accepts(rule, value);
    if (key == "anyOf") {
      return std::any_of(rule.begin(), rule.end(), [&](const Json& form) { return accepts(form, value); });
    }
    if (key == "oneOf") {
      return std::count_if(rule.begin(), rule.end(),
                           [&](const Json& form) { return accepts(form, value); }) == 1;
    }
    if (key == "pattern") {
      return !value.is_string() ||
             std::regex_search(value.get<std::string>(), std::regex(rule.get<std::string>()));
    }
    if (key == "minimum") return !value.is_number() || value.get<double>() >= rule.get<double>();
    if (key == "maximum") return !value.is_number() || value.get<double>() <= rule.get<double>();
    if (key == "exclusiveMinimum") return !value.is_number() || value.get<double>() > rule.get<double>();
    if (key == "minItems") return !value.is_array() || value.size() >= rule.get<std::size_t>();
    if (key == "maxItems") return !value.is_array() || value.size() <= rule.get<std::size_t>();
    if (key == "items") {
      return !value.is_array() ||
             std::all_of(value.begin(), value.end(), [&](const Json& item) { return accepts(rule, item); });
    }
    if (key == "required") {
      return !value.is_object() || std::all_of(rule.begin(), rule.end(), [&](const Json& name) {
        return value.contains(name.get<std::string>());
      });
    }
    if (key == "properties") return properties(rule, value);
    if (key == "additionalProperties") return additional(schema, rule, value);
    const bool says_nothing =
        key == "$schema" || key == "title" || key == "description" || key == "default" || key == "$defs";
    EXPECT_TRUE(says_nothing) << "unexpected keyword " << key;
    return true;
  }

  static bool type(const Json& rule, const Json& value) {
    if (rule.is_array()) {
      return std::any_of(rule.begin(), rule.end(), [&](const Json& one) { return type(one, value); });
    }
    const auto name = rule.get<std::string>();
    if (name == "object") return value.is_object();
    if (name == "array") return value.is_array();
    if (name == "string") return value.is_string();
    if (name == "boolean") return value.is_boolean();
    if (name == "integer") return value.is_number_integer();
    if (name == "number") return value.is_number();
    if (name == "null") return value.is_null();
    ADD_FAILURE() << "unknown type " << name;
    return false;
  }

  [[nodiscard]] bool properties(const Json& rule, const Json& value) const {
    if (!value.is_object()) return true;
    return std::all_of(rule.items().begin(), rule.items().end(), [&](const auto& item) {
      return !value.contains(item.key()) || accepts(item.value(), value.at(item.key()));
    });
  }

  [[nodiscard]] bool additional(const Json& schema, const Json& rule, const Json& value) const {
    if (!value.is_object()) return true;
    const Json known = schema.value("properties", Json::object());
    return std::all_of(value.items().begin(), value.items().end(), [&](const auto& item) {
      return known.contains(item.key()) || accepts(rule, item.value());
    });
  }

  Json root_;
};

class SchemaTest : public testing::Test {
 protected:
  SchemaTest() { register_toys(catalog_); }

  [[nodiscard]] bool accepts(const char* path, const Json& value) const {
    Json experiment = Json::parse(R"({
      "schema": 1, "name": "toy", "map": {"toy_map": {"path": "map.txt"}}, "observations": "toy_drive",
      "trials": {"every_m": 6}, "localizer": {"matcher": {"ransam": {"iterations": 5}}, "unknown_place": {"window": 3}},
      "evaluation": null
    })");
    const Json::json_pointer where(path);
    if (!where.empty()) experiment[where] = value;
    return Validator(experiment_schema(catalog_)).accepts(experiment);
  }

  Catalog catalog_;
};

TEST_F(SchemaTest, NamesItsDraft) {
  EXPECT_EQ(experiment_schema(catalog_)["$schema"], "https://json-schema.org/draft/2020-12/schema");
}

TEST_F(SchemaTest, AcceptsWhatTheReaderAccepts) {
  EXPECT_TRUE(accepts("", nullptr));
  EXPECT_TRUE(accepts("/localizer/matcher", "ransam"));
  EXPECT_TRUE(accepts("/localizer/matcher", "indexed"));
  EXPECT_TRUE(accepts("/localizer/matcher", {{"indexed", nullptr}}));
  EXPECT_TRUE(accepts("/localizer/matcher", {{"ransam", Json::object()}}));
  EXPECT_TRUE(accepts("/localizer/matcher", {{"ransam", {{"patience", "auto"}}}}));
  EXPECT_TRUE(accepts("/localizer/matcher", {{"ransam", {{"patience", 2.5}}}}));
  EXPECT_TRUE(accepts("/map/toy_map/segments", Json::parse("[[0, 0.5], [0.7, 1]]")));
  EXPECT_TRUE(accepts("/map/toy_map/walls", Json::parse("[{}, {\"height\": 2}]")));
  EXPECT_TRUE(accepts("/seed", 18446744073709551615ULL));
  EXPECT_TRUE(accepts("/output", {{"maps", "all"}}));
  EXPECT_TRUE(accepts("/variants", nullptr));
  EXPECT_TRUE(
      accepts("/variants/list", Json::parse(R"({"a": null, "b": {"seed": 3, "trials.starts_m": [1]}})")));
  for (const char* range :
       {"[1, 2.5]", R"({"from": 1, "to": 2, "scale": "log"})", R"({"choices": ["a", null]})"})
    EXPECT_TRUE(accepts("/variants/sample/ranges/seed", Json::parse(range))) << range;
  for (const char* seeds : {"7", "\"1..30\"", "[1, \"3..5\", 18446744073709551615]", "[]", "null"})
    EXPECT_TRUE(accepts("/seeds", Json::parse(seeds))) << seeds;
  for (const char* parts :
       {R"("intel")", R"(["intel", {"mine": "mine.yaml"}])", R"({"a": {"trials": {}}, "b": null})"})
    EXPECT_TRUE(accepts("/cases", Json::parse(parts))) << parts;
  EXPECT_TRUE(accepts("/variants/grid", Json::parse(R"({"seed": [1, 2], "localizer.matcher": ["ransam"]})")));
}

TEST_F(SchemaTest, RefusesWhatTheReaderRefuses) {
  EXPECT_FALSE(accepts("/sede", 3));
  EXPECT_FALSE(accepts("/seed", -1));
  EXPECT_FALSE(accepts("/seed", 1.5));
  EXPECT_FALSE(accepts("/schema", 2));
  EXPECT_FALSE(accepts("/threads", 0));
  EXPECT_FALSE(accepts("/threads", 257));
  EXPECT_FALSE(accepts("/map", "toy_map"));  // It has a key that must be given.
  EXPECT_FALSE(accepts("/map", {{"toy_map", nullptr}}));
  EXPECT_FALSE(accepts("/map/toy_map/resolution", 0));
  EXPECT_FALSE(accepts("/map/toy_map/segments", Json::array()));
  EXPECT_FALSE(accepts("/map/toy_map/segments", Json::parse("[[0, 1.5]]")));
  EXPECT_FALSE(accepts("/map/toy_map/segments", Json::parse("[[0]]")));
  EXPECT_FALSE(accepts("/map/toy_map/walls", Json::parse("[{}, {}, {}, {}]")));
  EXPECT_FALSE(accepts("/map/toy_map/walls", Json::parse("[{\"heigth\": 1}]")));
  EXPECT_FALSE(accepts("/localizer/matcher", {{"ransam", {{"patience", "soon"}}}}));
  EXPECT_FALSE(accepts("/localizer/matcher", {{"ransam", {{"patience", 0}}}}));
  EXPECT_FALSE(accepts("/localizer/matcher", "ransac"));
  EXPECT_FALSE(accepts("/localizer/matcher", {{"ransam", {{"iteration", 5}}}}));
  EXPECT_FALSE(accepts("/localizer/matcher", {{"ransam", nullptr}, {"indexed", nullptr}}));
  EXPECT_FALSE(accepts("/output", {{"maps", "first"}}));
  EXPECT_FALSE(accepts("/output", {{"steps", 1}}));
  EXPECT_FALSE(accepts("/variants/lists", Json::object()));
  EXPECT_FALSE(accepts("/variants/list", Json::parse(R"({"a": 3})")));
  EXPECT_FALSE(accepts("/variants/grid", Json::parse(R"({"seed": 3})")));
  EXPECT_FALSE(accepts("/variants/zip", Json::parse(R"({"seed": []})")));
  for (const char* range : {"[1]", R"({"from": 1})", R"({"choices": [], "from": 1, "to": 2})", "3"})
    EXPECT_FALSE(accepts("/variants/sample/ranges/seed", Json::parse(range))) << range;
  for (const char* seeds : {"-1", "1.5", "\"1..\"", "\"1..x\"", "\"5\"", "[[1]]", "{}"})
    EXPECT_FALSE(accepts("/seeds", Json::parse(seeds))) << seeds;
  EXPECT_FALSE(accepts("/methods", Json::parse(R"({"a": 3})")));
}

TEST_F(SchemaTest, KindWithoutStrategiesAcceptsNothing) {
  const Catalog empty;
  const Validator validator(experiment_schema(empty)["$defs"]["matcher"]);
  EXPECT_FALSE(validator.accepts("ransam"));
}

}  // namespace
}  // namespace glocal::test::schema_test
