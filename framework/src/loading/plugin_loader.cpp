#include "loading/plugin_loader.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <map>
#include <sstream>

#include "glocal/error.hpp"
#include "glocal/plugin.hpp"
#include "loading/shared_object.hpp"

namespace glocal {
namespace {

/// What the dynamic linker said last, without the file's name in front.
std::string linker_error(const std::filesystem::path& file) {
  const char* said = dlerror();
  const std::string text = said == nullptr ? "unknown error of the dynamic linker" : said;
  const std::string prefix = file.string() + ": ";
  return text.starts_with(prefix) ? text.substr(prefix.size()) : text;
}

void* open_library(const std::filesystem::path& file) {
  if (const auto why = why_no_shared_object(file)) throw ConfigError(file, *why);
  void* library = nullptr;
  // dlopen() is declared to throw nothing, and yet passes on what a plugin's static objects throw. Called by
  // its name, it would leave the compiler no reason to catch anything.
  void* (*volatile open)(const char*, int) = &dlopen;
  try {
    // RTLD_LOCAL: plugins do not see each other. RTLD_NODELETE: what they made may outlive everything.
    library = open(file.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  } catch (const std::exception& error) {
    throw ConfigError(file, fmt::format("threw an exception while it was loaded: {}", error.what()));
  } catch (...) {
    throw ConfigError(file, "threw something that is no std::exception while it was loaded");
  }
  if (library != nullptr) return library;
  const std::string said = linker_error(file);
  if (said.find("undefined symbol") != std::string::npos) {
    throw ConfigError(file, said + "; build it against this glocal, with all libraries it needs");
  }
  throw ConfigError(file, said + "; install what is missing, or add its folder to LD_LIBRARY_PATH");
}

using Properties = std::map<std::string, std::string>;

Properties properties_of(const std::string& tag) {
  Properties properties;
  std::istringstream lines(tag);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t colon = line.find(": ");
    if (colon != std::string::npos) properties[line.substr(0, colon)] = line.substr(colon + 2);
  }
  return properties;
}

/// "C++ ABI (it: 1016, glocal: 1017), …"; empty if nothing differs.
std::string differences(const std::string& its_tag, const std::string& own_tag) {
  const Properties its = properties_of(its_tag);
  const Properties own = properties_of(own_tag);
  Properties all = its;
  all.insert(own.begin(), own.end());
  const auto value = [](const Properties& properties, const std::string& name) {
    const auto found = properties.find(name);
    return found == properties.end() ? std::string("none") : found->second;
  };
  std::string text;
  for (const auto& [name, any] : all) {
    if (value(its, name) == value(own, name)) continue;
    text += fmt::format("{}{} (it: {}, glocal: {})", text.empty() ? "" : ", ", name, value(its, name),
                        value(own, name));
  }
  return text;
}

const Plugin& plugin_of(void* library, const std::filesystem::path& file) {
  void* symbol = dlsym(library, plugin_entry);
  if (symbol == nullptr) {
    throw ConfigError(
        file, fmt::format("not a glocal plugin: it has no function '{}'; define it with GLOCAL_PLUGIN",
                          plugin_entry));
  }
  const Plugin* plugin = nullptr;
  try {
    plugin = reinterpret_cast<PluginEntry>(symbol)();
  } catch (const std::exception& error) {
    throw ConfigError(file, fmt::format("'{}' threw an exception: {}", plugin_entry, error.what()));
  }
  if (plugin == nullptr || plugin->build_tag == nullptr) {
    throw ConfigError(file, fmt::format("'{}' returned nothing; define it with GLOCAL_PLUGIN", plugin_entry));
  }
  const std::string different = differences(plugin->build_tag, build_tag());
  if (!different.empty())
    throw ConfigError(file, "built otherwise than this glocal: " + different + "; build it again");
  return *plugin;
}

/// Registers under the plugin's name for as long as it lives.
class OriginOfRegistries {
 public:
  OriginOfRegistries(Catalog& catalog, const std::string& origin) : catalog_(catalog) { set(origin); }
  ~OriginOfRegistries() { set("glocal"); }
  OriginOfRegistries(const OriginOfRegistries&) = delete;
  OriginOfRegistries& operator=(const OriginOfRegistries&) = delete;

 private:
  void set(const std::string& origin) {
    for (RegistryBase* registry : catalog_.registries()) registry->set_origin(origin);
  }
  Catalog& catalog_;
};

/// Lets a plugin register its strategies. What it throws becomes a fault of the file.
template <class Work>
void register_all(const std::filesystem::path& file, const Work& work) {
  try {
    work();
  } catch (const ConfigError&) {
    throw;
  } catch (const std::invalid_argument& taken) {
    throw ConfigError(file, std::string(taken.what()) + "; rename one, or load only one of them");
  } catch (const std::exception& thrown) {
    throw ConfigError(
        file, fmt::format("threw an exception while it registered its strategies: {}", thrown.what()));
  } catch (...) {
    throw ConfigError(file, "threw something that is no std::exception while it registered its strategies");
  }
}

}  // namespace

void PluginLoader::load(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::path absolute = std::filesystem::weakly_canonical(file, error);
  const std::filesystem::path& path = error ? file : absolute;
  if (std::ranges::find(loaded_, path) != loaded_.end()) return;

  if (const auto other = others_.find(path.extension()); other != others_.end()) {
    const OriginOfRegistries origin(catalog_, path.filename().string());
    register_all(file, [&] { other->second(path, catalog_); });
  } else {
    const Plugin& plugin = plugin_of(open_library(path), file);
    const OriginOfRegistries origin(catalog_, fmt::format("{} {}", plugin.name, plugin.version));
    register_all(file, [&] { plugin.register_strategies(catalog_); });
  }
  loaded_.push_back(path);
}

std::vector<FilePath> PluginLoader::named() const {
  std::vector<FilePath> files;
  for (const std::filesystem::path& file : loaded_) files.push_back({file.string(), file});
  return files;
}

void PluginLoader::load_folders(const std::string& path) {
  std::istringstream folders(path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (folder.empty()) continue;
    std::error_code error;
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
      if (entry.path().extension() == ".so") files.push_back(entry.path());
    }
    if (error) {
      throw ConfigError(
          folder,
          fmt::format("a folder of plugins (GLOCAL_PLUGIN_PATH) that cannot be read: {}", error.message()));
    }
    std::ranges::sort(files);
    for (const auto& file : files) load(file);
  }
}

}  // namespace glocal
