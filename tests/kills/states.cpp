// The states in which a power failure may leave a folder: power_loss_states BEFORE RECORD OUT MOST
// BEFORE is the folder as it was, all of it on the disk; RECORD is what record.cpp has written. Of the states
// that differ from each other MOST go to OUT/NUMBER, and what the program leaves without a power failure to
// OUT/end. The output has the number of all states, and a line for each that was written: its number, how
// many trials are finished in it, and what it is.
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

namespace fs = std::filesystem;

/// What is in a file or folder, and what of that is on the disk: as POSIX has it, data after fsync of the
/// file, names after fsync of the folder.
struct Node {
  bool is_folder = false;
  std::string data, synced_data;
  std::map<std::string, std::shared_ptr<Node>> names, synced_names;
};
using NodePtr = std::shared_ptr<Node>;

/// What survives of that which is not synced. File systems may write names and data in any order.
enum class Survives { nothing, names, names_and_lengths, data, all };
constexpr std::array<std::pair<Survives, const char*>, 5> ways = {
    {{Survives::nothing, "only what is synced"},
     {Survives::names, "all names, but only synced data"},
     {Survives::names_and_lengths, "all names and lengths, zeros for data that is not synced"},
     {Survives::data, "all data, but only synced names"},
     {Survives::all, "everything"}}};

/// Files with their content, folders with a slash behind their name.
using Tree = std::map<std::string, std::string>;

void sync(Node& node) {
  node.synced_data = node.data;
  node.synced_names = node.names;
}

void sync_all(Node& node) {
  sync(node);
  for (const auto& [name, child] : node.names) sync_all(*child);
}

NodePtr read(const fs::path& path) {
  auto node = std::make_shared<Node>();
  node->is_folder = fs::is_directory(path);
  if (node->is_folder) {
    for (const auto& entry : fs::directory_iterator(path))
      node->names[entry.path().filename()] = read(entry.path());
  } else {
    std::ifstream in(path, std::ios::binary);
    node->data.assign(std::istreambuf_iterator<char>(in), {});
  }
  sync(*node);
  return node;
}

class Disk {
 public:
  explicit Disk(const fs::path& before) : root_(read(before)) {}

  void apply(const std::vector<std::string>& words);
  [[nodiscard]] Tree left(Survives what) const {
    Tree tree;
    add(*root_, "", what, tree);
    return tree;
  }

 private:
  [[nodiscard]] Node& folder_of(const fs::path& path) const { return *find(path.parent_path()); }
  [[nodiscard]] NodePtr find(const fs::path& path) const;
  void make(const fs::path& path, bool is_folder) const;
  static void add(const Node& node, const std::string& path, Survives what, Tree& tree);

  NodePtr root_;
};

NodePtr Disk::find(const fs::path& path) const {
  NodePtr node = root_;
  for (const fs::path& part : path) {
    if (part != ".") node = node->names.at(part);
  }
  return node;
}

void Disk::make(const fs::path& path, bool is_folder) const {
  auto node = std::make_shared<Node>();
  node->is_folder = is_folder;
  folder_of(path).names[path.filename()] = node;
}

std::string bytes(const std::string& hexadecimal) {
  std::string text;
  for (std::size_t i = 0; i + 1 < hexadecimal.size(); i += 2)
    text += static_cast<char>(std::stoi(hexadecimal.substr(i, 2), nullptr, 16));
  return text;
}

void Disk::apply(const std::vector<std::string>& words) {
  const std::string& call = words.at(0);
  const fs::path path = words.at(1);
  // Who writes into a file without a name leaves nothing.
  if (path.string().ends_with(" (deleted)")) return;
  if (call == "mkdir" || call == "create") {
    make(path, call == "mkdir");
  } else if (call == "resize") {
    find(path)->data.resize(std::stoul(words.at(2)));
  } else if (call == "write") {
    const std::string content = bytes(words.at(3));
    const std::size_t at = std::stoul(words.at(2));
    std::string& data = find(path)->data;
    data.resize(std::max(data.size(), at + content.size()));
    data.replace(at, content.size(), content);
  } else if (call == "sync") {
    sync(*find(path));
  } else if (call == "syncfs") {
    sync_all(*root_);
  } else if (call == "remove") {
    folder_of(path).names.erase(path.filename());
  } else if (call == "rename") {
    const fs::path to = words.at(2);
    const NodePtr node = find(path);
    folder_of(path).names.erase(path.filename());
    folder_of(to).names[to.filename()] = node;
  } else {
    throw std::runtime_error("the record has an operation that is not imitated: " + call + " " + words.at(1));
  }
}

void Disk::add(const Node& node, const std::string& path, Survives what, Tree& tree) {
  const bool all_names = what != Survives::nothing && what != Survives::data;
  for (const auto& [name, child] : all_names ? node.names : node.synced_names) {
    const std::string here = path + name;
    if (child->is_folder) {
      tree[here + "/"];
      add(*child, here + "/", what, tree);
      continue;
    }
    std::string data = what == Survives::data || what == Survives::all ? child->data : child->synced_data;
    if (what == Survives::names_and_lengths) data.resize(child->data.size(), '\0');
    tree[here] = std::move(data);
  }
}

void write(const Tree& tree, const fs::path& folder) {
  fs::create_directories(folder);
  for (const auto& [name, content] : tree) {
    if (name.ends_with('/')) {
      fs::create_directories(folder / name);
    } else {
      std::ofstream(folder / name, std::ios::binary) << content;
    }
  }
}

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> words;
  std::istringstream in(line);
  for (std::string word; std::getline(in, word, '\t');) words.push_back(word);
  return words;
}

/// How many trials are finished: those whose line in the journal was synced.
class FinishedTrials {
 public:
  void see(const std::vector<std::string>& words) {
    const bool is_journal = words[1].find("/journal/") != std::string::npos;
    // Behind the checksum.
    if (is_journal && words[0] == "write" && bytes(words[3]).find(" trial ") == 8) ++lines_;
    if (is_journal && words[0] == "sync") count_ = lines_;
    // The run is over, and later trials are of another variant.
    if (words[0] == "rename" && words[1].ends_with(".unfinished")) lines_ = count_ = 0;
  }
  [[nodiscard]] std::size_t count() const { return count_; }

 private:
  std::size_t lines_ = 0, count_ = 0;
};

/// States that differ from each other.
class States {
 public:
  void add(const Disk& disk, std::size_t finished, const std::string& after) {
    for (const auto& [what, words] : ways) {
      const auto [known, is_new] = known_.emplace(disk.left(what), states_.size());
      if (is_new) states_.push_back({&known->first, 0, words + (", " + after)});
      // The same files may be left later, too, when more should be there.
      std::size_t& most = states_[known->second].finished;
      most = std::max(most, finished);
    }
  }

  /// Their number, and those that are written: their names and what they are. `most` of them, evenly.
  void write_to(const fs::path& out, std::size_t most) const {
    std::cout << states_.size() << '\n';
    const std::size_t all = states_.size();
    for (std::size_t i = 0; i < all; ++i) {
      if (most < all && (i + 1) * most / all == i * most / all) continue;
      write(*states_[i].tree, out / std::to_string(i));
      std::cout << i << '\t' << states_[i].finished << '\t' << states_[i].what << '\n';
    }
  }

 private:
  struct State {
    const Tree* tree;
    std::size_t finished;  ///< Trials.
    std::string what;
  };
  std::map<Tree, std::size_t> known_;  ///< Which of the states they are.
  std::vector<State> states_;
};

void run(const fs::path& before, const fs::path& record, const fs::path& out, std::size_t most) {
  Disk disk(before);
  States states;
  std::ifstream in(record);
  std::size_t calls = 0;
  FinishedTrials trials;
  for (std::string line; std::getline(in, line);) {
    const std::vector<std::string> words = split(line);
    disk.apply(words);
    trials.see(words);
    states.add(disk, trials.count(),
               "after call " + std::to_string(++calls) + ": " + words[0] + " " + words[1]);
  }
  states.write_to(out, most);
  write(disk.left(Survives::all), out / "end");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  try {
    run(argv[1], argv[2], argv[3], std::stoul(argv[4]));
  } catch (const std::exception& error) {
    std::cerr << "power_loss_states: " << error.what() << '\n';
    return 1;
  }
}
