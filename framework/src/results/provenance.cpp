#include "results/provenance.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "glocal/error.hpp"
#include "version.hpp"

namespace glocal {
namespace {

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

std::string cpu_model() {
  std::ifstream cpuinfo("/proc/cpuinfo");
  for (std::string line; std::getline(cpuinfo, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

}  // namespace

std::string sha256_of_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw RunError(file.string() + ": cannot read");
  const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context(EVP_MD_CTX_new(), &EVP_MD_CTX_free);
  EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr);
  std::array<char, 65536> buffer{};
  while (in.read(buffer.data(), buffer.size()), in.gcount() > 0) {
    EVP_DigestUpdate(context.get(), buffer.data(), static_cast<std::size_t>(in.gcount()));
  }
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned length = 0;
  EVP_DigestFinal_ex(context.get(), digest.data(), &length);
  std::string hex;
  for (unsigned i = 0; i < length; ++i) hex += fmt::format("{:02x}", digest.at(i));
  return hex;
}

nlohmann::ordered_json provenance(const Catalog& catalog, int threads,
                                  const std::set<std::filesystem::path>& inputs) {
  nlohmann::ordered_json files = nlohmann::ordered_json::object();
  for (const std::filesystem::path& input : inputs) files[input.string()] = sha256_of_file(input);
  std::set<std::string> origins;
  for (const RegistryBase* registry : catalog.registries()) {
    for (const StrategyInfo* info : registry->all()) origins.insert(info->origin);
  }
  origins.erase("glocal");
  return {{"version", version},
          {"revision", revision()},
          {"compiler", compiler},
          {"host", host_name()},
          {"cpu", cpu_model()},
          {"threads", threads},
          {"inputs_sha256", std::move(files)},
          {"plugins", origins}};
}

}  // namespace glocal
