// A page with its data in it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace glocal {

/// What a page shows.
struct PageData {
  nlohmann::ordered_json head;           ///< What came out; enough for a page without steps.
  std::vector<std::string> chunks = {};  ///< packed(); what a trial of the head names by its "chunk".
};

struct PageFile {
  std::string name;
  std::string content;
};

/// Takes the chunks out of the data: as scripts that are to lie in `folder` beside the page, which loads one
/// when it is asked for a trial's steps. Their names begin with a hash of all of them, so that those of
/// another page can lie in the same folder until that is replaced.
[[nodiscard]] std::vector<PageFile> put_beside(PageData& data, const std::string& folder);

/// Whether a file of that name may be one of put_beside().
[[nodiscard]] bool is_beside_file(std::string_view name);

/// What the page needs to show these data in space; nothing if their maps are planar, or if they have none.
/// It is larger than all the rest of the page.
[[nodiscard]] std::string_view script_for(const nlohmann::ordered_json& head);

/// The page with title and data in the places of their marks, script_for() them after them, and leave to load
/// scripts where some lie beside it.
[[nodiscard]] std::string page_with(std::string_view page, const std::string& title, const PageData& data);

}  // namespace glocal
