// The one function a plugin exports.
//
//     #include <glocal/plugin.hpp>
//
//     GLOCAL_PLUGIN("my_matcher", "0.1.0", catalog) {
//       catalog.matchers.add<MyMatcher>("my_matcher", "Proposes poses in my own way.");
//     }
//
// It brings all that strategies usually need: the values and interfaces, contact with the map, means of
// clusters, and the parts of the standard library that go with them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>
#include <string>
#include <unordered_set>
#include <vector>

#include "glocal/catalog.hpp"
#include "glocal/clusters_of.hpp"
#include "glocal/contact.hpp"

namespace glocal {

/// Counts up when interfaces or values change so that plugins must be changed or built again.
inline constexpr int plugin_api_version = 15;

/// What glocal and a plugin must have in common to understand each other, as whoever includes this header was
/// compiled: a line for each property, "name: value".
[[nodiscard]] inline const std::string& build_tag() {
  static const std::string tag = [] {
    const auto line = [](const char* name, auto value) {
      return std::string(name) + ": " + std::to_string(value) + "\n";
    };
    std::string text = line("API version", plugin_api_version);
#if defined(__clang__)
    text += line("compiler Clang", __clang_major__);
#elif defined(__GNUC__)
    text += line("compiler GCC", __GNUC__);
#else
#error "glocal's plugins need GCC or Clang"
#endif
    text += line("C++ ABI", __GXX_ABI_VERSION);
#ifdef _GLIBCXX_USE_CXX11_ABI
    text += line("std::string's ABI", _GLIBCXX_USE_CXX11_ABI);
#endif
    // As Eigen aligns its fixed-size vectors, so that those who hand some on agree.
#if defined(__AVX512F__)
    text += line("vector alignment", 64);
#elif defined(__AVX__)
    text += line("vector alignment", 32);
#else
    text += line("vector alignment", 16);
#endif
    text += line("size of Pose3", sizeof(Pose3));
    text += line("size of Points", sizeof(Points));
    text += line("size of Sample", sizeof(Sample));
    text += line("size of LocalMap", sizeof(LocalMap));
    text += line("size of MapData", sizeof(MapData));
    text += line("size of GlobalMap", sizeof(GlobalMap));
    text += line("size of Hypothesis", sizeof(Hypothesis));
    text += line("size of Cluster", sizeof(Cluster));
    text += line("size of StepResult", sizeof(StepResult));
    text += line("size of FieldInfo", sizeof(FieldInfo));
    text += line("size of SourceSetup", sizeof(SourceSetup));
    text += line("size of StageSetup", sizeof(StageSetup));
    text += line("size of Catalog", sizeof(Catalog));
    return text;
  }();
  return tag;
}

/// What a plugin says of itself. Only `build_tag` may be looked at before it is known to agree.
struct Plugin {
  const char* build_tag;
  const char* name;
  const char* version;
  void (*register_strategies)(Catalog& catalog);
};

/// The name of the function a plugin exports, and its type.
inline constexpr const char* plugin_entry = "glocal_plugin";
using PluginEntry = const Plugin* (*)();

}  // namespace glocal

/// Defines the function; what follows in braces adds strategies to `catalog`. Exceptions end the loading.
// NOLINTBEGIN(bugprone-macro-parentheses): a parameter's name cannot be in parentheses
#define GLOCAL_PLUGIN(plugin_name, plugin_version, catalog)                                      \
  static void glocal_register_strategies(glocal::Catalog& catalog);                              \
  extern "C" __attribute__((visibility("default"))) const glocal::Plugin* glocal_plugin();       \
  extern "C" const glocal::Plugin* glocal_plugin() {                                             \
    static const glocal::Plugin plugin{glocal::build_tag().c_str(), plugin_name, plugin_version, \
                                       &glocal_register_strategies};                             \
    return &plugin;                                                                              \
  }                                                                                              \
  static void glocal_register_strategies(glocal::Catalog& catalog)
// NOLINTEND(bugprone-macro-parentheses)
