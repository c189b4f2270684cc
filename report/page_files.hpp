// A page as a file, perhaps with a folder beside it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "report/page.hpp"
#include "report/page_text.hpp"

namespace glocal {

struct PageFileOptions {
  std::size_t most_bytes = 3'000'000;  ///< Such a page opens at once, and goes by mail.
  bool replace = false;                ///< A file that is there.
};

/// Writes the page, whole or not at all. The chunks of one that would be larger lie in a folder beside it,
/// which has the file's name with "_steps" in the place of its ending; a page that is replaced finds its own
/// ones until then, and loses them afterwards. Throws as AtomicFiles does.
void write_page(const std::filesystem::path& file, const std::string& title, PageData data,
                const PageFileOptions& options, std::string_view page = page_text);

}  // namespace glocal
