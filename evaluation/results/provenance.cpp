#include "evaluation/results/provenance.hpp"

#include <dlfcn.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <link.h>
#include <openssl/evp.h>
#include <unistd.h>

#include <array>
#include <ctime>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>

#include "config/suites.hpp"
#include "evaluation/results/file_io.hpp"
#include "evaluation/results/json_text.hpp"
#include "evaluation/results/results_folder.hpp"
#include "glocal/error.hpp"
#include "version.hpp"

namespace glocal {
namespace {

using Json = nlohmann::ordered_json;

std::string cpu_model() {
  std::ifstream cpuinfo("/proc/cpuinfo");
  for (std::string line; std::getline(cpuinfo, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

/// The shared object that a function is in.
template <class Function>
std::filesystem::path object_of(Function* function) {
  Dl_info object{};
  // A pointer to a function, as dladdr wants it.
  const bool found = dladdr(reinterpret_cast<const void*>(function), &object) != 0;  // NOLINT
  return found ? std::filesystem::canonical(object.dli_fname) : std::filesystem::path();
}

/// The library of built-in strategies, if a program that embeds glocal has loaded it; empty otherwise.
std::string builtin_library() {
  std::string found;
  const auto look = [](dl_phdr_info* object, std::size_t /*size*/, void* result) {
    const std::filesystem::path file = object->dlpi_name;
    if (!file.filename().string().starts_with("libglocal_builtin.so")) return 0;
    *static_cast<std::string*>(result) = object->dlpi_name;
    return 1;
  };
  dl_iterate_phdr(look, &found);
  return found;
}

Json program_sha256(FileHashes& hashes) {
  Json files = {{"program", hashes.of("/proc/self/exe")},
                {"library", hashes.of(object_of(&revision))},
                {"evaluation", hashes.of(object_of(&sha256_of_file))}};
  if (const std::string builtin = builtin_library(); !builtin.empty()) files["builtin"] = hashes.of(builtin);
  return files;
}

class Sha256 {
 public:
  Sha256() { EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr); }
  void add(std::string_view bytes) { EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()); }
  /// In hexadecimal digits; to be called once.
  std::string text() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned length = 0;
    EVP_DigestFinal_ex(context_.get(), digest.data(), &length);
    std::string hex;
    for (unsigned i = 0; i < length; ++i) hex += fmt::format("{:02x}", digest.at(i));
    return hex;
  }

 private:
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_{EVP_MD_CTX_new(), &EVP_MD_CTX_free};
};

/// A line for each file that is not hidden.
std::string names_in(const std::filesystem::path& folder) {
  std::set<std::string> names;
  std::error_code error, unreachable;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (entry.is_regular_file(unreachable) && !name.starts_with('.')) names.insert(name);
  }
  if (error) throw RunError(folder.string() + ": cannot read");
  return fmt::format("{}\n", fmt::join(names, "\n"));
}

/// Whether an effective.yaml has other values. Its comments, which tell what follows from the map, are none.
bool has_other_values(const std::string& there, const std::string& here) {
  try {
    return settings_of(there, "effective.yaml", {}) != settings_of(here, "effective.yaml", {});
  } catch (const ConfigError&) {
    return true;
  }
}

bool is_still(const std::string& file, const Json& hash, FileHashes& hashes) {
  try {
    return hashes.of(file) == hash;
  } catch (const RunError&) {
    return false;
  }
}

}  // namespace

const std::string& FileHashes::of(const std::filesystem::path& file) {
  auto known = known_.find(file);
  if (known == known_.end()) {
    const bool is_folder = std::filesystem::is_directory(file);
    known = known_.emplace(file, is_folder ? sha256_of_text(names_in(file)) : sha256_of_file(file)).first;
  }
  return known->second;
}

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

std::string sha256_of_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw RunError(file.string() + ": cannot read");
  Sha256 hash;
  std::array<char, 65536> buffer{};
  while (in.read(buffer.data(), buffer.size()), in.gcount() > 0)
    hash.add({buffer.data(), static_cast<std::size_t>(in.gcount())});
  return hash.text();
}

std::string sha256_of_text(std::string_view text) {
  Sha256 hash;
  hash.add(text);
  return hash.text();
}

Json program_identity(FileHashes& hashes) {
  return {{"version", version}, {"revision", revision()}, {"program_sha256", program_sha256(hashes)}};
}

Json provenance(const Catalog& catalog, int threads, const std::set<std::filesystem::path>& inputs,
                FileHashes& hashes) {
  Json files = Json::object();
  for (const std::filesystem::path& input : inputs) files[input.string()] = hashes.of(input);
  std::set<std::string> origins;
  for (const RegistryBase* registry : catalog.registries()) {
    for (const StrategyInfo* info : registry->all()) origins.insert(valid_utf8(info->origin));
  }
  origins.erase("glocal");
  Json json = program_identity(hashes);
  json.update({{"compiler", compiler},
               {"host", host_name()},
               {"cpu", cpu_model()},
               {"threads", threads},
               {"inputs_sha256", std::move(files)},
               {"plugins", origins}});
  return json;
}

Json origin_json(const Variant& variant) {
  if (variant.name.empty()) return {};
  Json values = Json::object();
  for (const auto& [path, value] : variant.values) values[path] = valid_utf8(value);
  Json origin = {{"setting", variant.setting},
                 {"seed", variant.experiment.seed},
                 {"case", variant.case_name},
                 {"role", to_string(variant.role)},
                 {"values", std::move(values)}};
  if (variant.suite) origin.update({{"suite", variant.suite->id()}, {"share", variant.share}});
  return origin;
}

Json provenance_of_run(const Catalog& catalog, const Variant& variant, const RunOptions& options,
                       const std::set<std::filesystem::path>& inputs, FileHashes& hashes) {
  Json json = provenance(catalog, variant.experiment.threads, inputs, hashes);
  json["jobs"] = options.jobs;
  json["began"] = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
  if (!options.command.empty()) json["command"] = valid_utf8(options.command);
  if (Json origin = origin_json(variant); !origin.is_null()) json["variant"] = std::move(origin);
  return json;
}

std::optional<std::string> why_other_run(const std::filesystem::path& folder, const std::string& effective,
                                         const Json& origin, const std::filesystem::path& experiment_file,
                                         const std::vector<std::filesystem::path>& plugins,
                                         FileHashes& hashes) {
  if (has_other_values(content_of(folder / "effective.yaml"), effective))
    return "it is of other values (effective.yaml)";
  Json record;
  try {
    record = parse_json(content_of(folder / "provenance.json"));
  } catch (const std::exception&) {
    return "its provenance.json is damaged";
  }
  const auto text_at = [&](const char* key) {
    return record.is_object() ? record.value(key, Json()) : Json();
  };
  const Json program = program_identity(hashes);
  for (const auto& [key, value] : program.items()) {
    if (text_at(key.c_str()) != value) return "it is of another build of the program";
  }
  if (text_at("variant") != origin) return "it is of another part of the experiment (provenance.json)";
  const Json inputs = text_at("inputs_sha256");
  for (const auto& [file, hash] : inputs.items()) {
    if (file != experiment_file && !is_still(file, hash, hashes)) return file + " has changed since";
  }
  for (const std::filesystem::path& plugin : plugins) {
    if (!inputs.contains(plugin.string())) return "it is without " + plugin.string();
  }
  return std::nullopt;
}

}  // namespace glocal
