#include "config/suites.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "config/builtin_parts.hpp"
#include "config/products.hpp"
#include "config/reader.hpp"
#include "config/scalars.hpp"
#include "config/text_file.hpp"
#include "config/variants.hpp"
#include "config/yaml_parser.hpp"
#include "glocal/rng.hpp"
#include "glocal/words.hpp"

namespace glocal {
namespace {

namespace fs = std::filesystem;

/// FNV-1a with 64 bits (Fowler, Noll and Vo).
std::uint64_t fnv1a(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  return hash;
}

/// "planar@1" as name and version; none where it has none.
std::pair<std::string, std::string> split(const std::string& text) {
  const std::size_t at = text.rfind('@');
  const bool is_version = at != std::string::npos && at + 1 < text.size() &&
                          std::all_of(text.begin() + static_cast<std::ptrdiff_t>(at) + 1, text.end(),
                                      [](char c) { return c >= '0' && c <= '9'; });
  if (!is_version) return {text, ""};
  return {text.substr(0, at), text.substr(at + 1)};
}

/// Reads one file.
class SuiteReader {
 public:
  explicit SuiteReader(std::vector<Fault>& faults) : faults_(faults) {}

  SuiteFile read(const YamlNode& tree, const fs::path& file) {
    read_.suite.name = file.stem().string();
    read_.suite.file = file;
    if (!is_folder_name(read_.suite.name))
      refuse(tree.place,
             fmt::format("'{}' is no name for a suite; rename the file", shown(read_.suite.name)));
    for (const char* key : {"version", "cases"}) {
      if (find_entry(tree, key) == nullptr) refuse(tree.place, fmt::format("missing key '{}'", key));
    }
    for (const YamlEntry& entry : tree.entries) {
      if (entry.key == "version") {
        take(entry.value, "version", {.doc = "", .min = 1.0}, read_.suite.version);
      } else if (entry.key == "seeds") {
        read_.seeds = entry.value;
      } else if (entry.key == "cases") {
        read_.cases = entry.value;
      } else if (entry.key == "disturbances") {
        read_.disturbances = entry.value;
      } else if (entry.key == "pinned") {
        read_pinned(entry.value);
      } else if (entry.key == "published") {
        for_each_entry(entry.value, [&](const YamlEntry& of_case) { read_published(of_case); });
      } else {
        refuse(entry.place,
               fmt::format(
                   "unknown key '{}'; a suite has version, cases, seeds, disturbances, published and pinned",
                   shown(entry.key)));
      }
    }
    if (read_.seeds.kind == NodeKind::null) read_.seeds = make_scalar(tree.place, "1");
    read_.suite.seeds = numbers_of({std::make_shared<const YamlNode>(read_.seeds)}, "seeds", faults_);
    return std::move(read_);
  }

 private:
  void refuse(const Place& place, std::string message) {
    faults_.push_back(fault_at(place, "suite: " + std::move(message)));
  }

  template <class T>
  void take(const YamlNode& node, const std::string& key, const FieldInfo& info, T& value) {
    if (const Refusal why = take_value(node, info, value)) refuse(node.place, key + ": " + *why);
  }

  template <class Work>
  void for_each_entry(const YamlNode& node, const Work& work) {
    if (node.kind != NodeKind::map) return refuse(node.place, "expected a map, got " + name_of(node));
    for (const YamlEntry& entry : node.entries) work(entry);
  }

  void read_pinned(const YamlNode& pinned) {
    read_.suite.is_pinned = true;
    for_each_entry(pinned, [&](const YamlEntry& part) {
      if (part.key == "inputs") {
        for_each_entry(part.value,
                       [&](const YamlEntry& input) { read_.suite.inputs[input.key] = input.value.text; });
      } else if (part.key == "cases") {
        for_each_entry(part.value, [&](const YamlEntry& one) { read_pinned_case(one); });
      } else {
        refuse(part.place,
               fmt::format("pinned: unknown key '{}'; there are cases and inputs", shown(part.key)));
      }
    });
  }

  void read_pinned_case(const YamlEntry& entry) {
    SuiteCase pinned{entry.key, "", 0};
    for_each_entry(entry.value, [&](const YamlEntry& value) {
      if (value.key == "values") {
        pinned.values = value.value.text;
      } else if (value.key == "starts") {
        int starts = 0;
        take(value.value, "starts", {.doc = "", .min = 1.0, .max = 1'000'000.0}, starts);
        pinned.starts = static_cast<std::size_t>(starts);
      } else {
        refuse(value.place,
               fmt::format("pinned.cases: unknown key '{}'; there are starts and values", shown(value.key)));
      }
    });
    read_.suite.cases.push_back(std::move(pinned));
  }

  void read_published(const YamlEntry& entry) {
    PublishedFigures figures{.case_name = entry.key};
    for_each_entry(entry.value, [&](const YamlEntry& value) {
      if (value.key == "translation_cm") {
        take(value.value, value.key, {.doc = "", .above = 0.0}, figures.translation_cm);
      } else if (value.key == "rotation_deg") {
        take(value.value, value.key, {.doc = "", .above = 0.0}, figures.rotation_deg);
      } else if (value.key == "about") {
        take(value.value, value.key, {.doc = ""}, figures.about);
      } else {
        refuse(value.place,
               fmt::format("published: unknown key '{}'; there are translation_cm, rotation_deg and about",
                           shown(value.key)));
      }
    });
    read_.suite.published.push_back(std::move(figures));
  }

  SuiteFile read_;
  std::vector<Fault>& faults_;
};

}  // namespace

std::string Suite::id() const {
  return fmt::format("{}@{}", name, version);
}

const SuiteCase* Suite::find_case(std::string_view case_name) const {
  const auto found = std::ranges::find(cases, case_name, &SuiteCase::name);
  return found == cases.end() ? nullptr : &*found;
}

std::string hash_of(std::string_view text) {
  return fmt::format("{:016x}", fnv1a(text));
}

bool is_in_share(std::string_view case_name, std::uint64_t seed, std::size_t start, double share) {
  return Rng(fnv1a(case_name)).stream({seed, start}).uniform() < share;
}

std::vector<std::size_t> starts_in_share(const SuiteCase& one_case, std::uint64_t seed, double share) {
  std::vector<std::size_t> starts;
  for (std::size_t start = 0; start < one_case.starts; ++start) {
    if (is_in_share(one_case.name, seed, start, share)) starts.push_back(start);
  }
  return starts;
}

std::string input_name(const Suite& suite, const fs::path& input) {
  const fs::path file = fs::absolute(input).lexically_normal();
  if (const char* datasets = std::getenv("GLOCAL_DATASETS"); datasets != nullptr && *datasets != '\0') {
    const fs::path below = file.lexically_relative(fs::absolute(datasets).lexically_normal());
    if (!below.empty() && *below.begin() != "..") return "data:" + below.generic_string();
  }
  return file.lexically_relative(fs::absolute(suite.file).lexically_normal().parent_path()).generic_string();
}

std::optional<SuiteFile> read_suite_file(const YamlNode& value, std::vector<Fault>& faults) {
  YamlNode name = value;
  const auto [text, version] = split(value.text);
  name.text = text;
  if (value.kind != NodeKind::scalar) {
    add_fault(faults, value.place, "suite: expected a name or a file, got {}", name_of(value));
    return std::nullopt;
  }
  const auto file = part_file(PartKind::suite, name, faults);
  if (!file) return std::nullopt;
  const std::size_t before = faults.size();
  const auto tree = parse_yaml(read_text_file(*file), origin_of(*file), faults);
  if (tree && tree->kind != NodeKind::map)
    add_fault(faults, tree->place, "suite: expected a map, got {}", name_of(*tree));
  if (!tree || faults.size() > before) return std::nullopt;
  SuiteFile read = SuiteReader(faults).read(*tree, *file);
  if (!version.empty() && version != std::to_string(read.suite.version))
    add_fault(faults, value.place, "suite: there is no {}; there is {}", shown(value.text), read.suite.id());
  if (faults.size() > before) return std::nullopt;
  return read;
}

Suite read_suite(const std::string& name) {
  const auto origin = std::make_shared<const Origin>(Origin{"--suite " + name, "."});
  std::vector<Fault> faults;
  auto read = read_suite_file(make_scalar({origin}, name), faults);
  if (!read) throw ConfigError(std::move(faults));
  return std::move(read->suite);
}

}  // namespace glocal
