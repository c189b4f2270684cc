# Writes OUTPUT with the revision of the tree at SOURCE_DIR; touches it only when that changes. Run at every build.
cmake_minimum_required(VERSION 3.25)
execute_process(COMMAND git -C ${SOURCE_DIR} describe --always --dirty --abbrev=12 --exclude=*
  OUTPUT_VARIABLE revision OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  set(revision "unknown")
endif()
file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT
"#include \"version.hpp\"

namespace glocal {

const char* revision() { return \"@revision@\"; }

}  // namespace glocal
")
