// As if built against another glocal.
#include "glocal/plugin.hpp"

extern "C" __attribute__((visibility("default"))) const glocal::Plugin* glocal_plugin() {
  static const glocal::Plugin plugin{"API version: 999\ncompiler GCC: 4\n", "old", "1", nullptr};
  return &plugin;
}
