# Puts a text into a C++ source: cmake -DTEXT=FILE -DOUTPUT=FILE -P embed.cmake
file(READ ${TEXT} text)
string(FIND "${text}" ")~page~\"" end)
if(NOT end EQUAL -1)
  message(FATAL_ERROR "${TEXT} holds what ends a raw string")
endif()
# A bracket argument and no substitution: the text may hold anything.
file(WRITE ${OUTPUT} [[#include "report/page_text.hpp"

const std::string_view glocal::page_text = R"~page~(]])
file(APPEND ${OUTPUT} "${text}")
file(APPEND ${OUTPUT} [[)~page~";
]])
