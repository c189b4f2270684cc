// The page of report/page, as it was built.
#pragma once

#include <string_view>

namespace glocal {

/// HTML with the places where title and data go: <!--glocal:title--> and <!--glocal:data-->.
extern const std::string_view page_text;

/// The same for the page of the leaderboard.
extern const std::string_view board_text;

/// JavaScript that draws maps in space, for pages that have some.
extern const std::string_view space_text;

}  // namespace glocal
