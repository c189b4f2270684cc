#include "report/page_files.hpp"

#include <algorithm>
#include <system_error>
#include <vector>

#include "evaluation/results/atomic_file.hpp"

namespace glocal {
namespace {

namespace fs = std::filesystem;

/// Removes scripts of a page that was there before, and the folder with the last one.
void remove_others(const fs::path& folder, const std::vector<PageFile>& files) {
  std::error_code ignored;
  std::vector<fs::path> others;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    const bool is_ours =
        std::any_of(files.begin(), files.end(), [&](const PageFile& f) { return f.name == name; });
    if (is_beside_file(name) && !is_ours) others.push_back(entry.path());
  }
  for (const fs::path& other : others) fs::remove(other, ignored);
  if (files.empty() && !others.empty()) fs::remove(folder, ignored);  // unless something else lies there
}

}  // namespace

void write_page(const fs::path& file, const std::string& title, PageData data, const PageFileOptions& options,
                std::string_view page) {
  const fs::path folder = file.parent_path() / (file.stem().string() + "_steps");
  std::string text = page_with(page, title, data);
  std::vector<PageFile> beside;
  if (text.size() > options.most_bytes && !data.chunks.empty()) {
    beside = put_beside(data, folder.filename().string());
    text = page_with(page, title, data);
  }
  AtomicFiles pages(options.replace);
  pages.add(file, text);
  AtomicFiles scripts(true);
  for (const PageFile& script : beside) scripts.add(folder / script.name, script.content);
  // Scripts come first: whichever page is there finds its own.
  scripts.commit();
  pages.commit();
  remove_others(folder, beside);
}

}  // namespace glocal
