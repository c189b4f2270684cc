// The page of framework/page, as it was built.
#pragma once

#include <string_view>

namespace glocal {

/// HTML with the places where title and data go: <!--glocal:title--> and <!--glocal:data-->.
extern const std::string_view page_text;

}  // namespace glocal
