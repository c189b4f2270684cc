# Puts a text into a C++ source: cmake -DTEXT=FILE -DNAME=NAME -DOUTPUT=FILE -P embed.cmake
file(READ ${TEXT} text)
string(FIND "${text}" ")~page~\"" end)
if(NOT end EQUAL -1)
  message(FATAL_ERROR "${TEXT} holds what ends a raw string")
endif()
# A bracket argument and no substitution: the text may hold anything.
file(WRITE ${OUTPUT} "#include \"report/page_text.hpp\"

const std::string_view glocal::${NAME} = R\"~page~(")
file(APPEND ${OUTPUT} "${text}")
file(APPEND ${OUTPUT} [[)~page~";
]])
