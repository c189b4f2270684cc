// A shared object, but no plugin.
extern "C" int glocal_plugin_entry() {
  return 42;
}
