# Makes the plain comment at the head of a header one of the file, for Doxygen.
FNR == 1 && /^\/\/ / { head = 1; print "/// \\file" }
head && !/^\/\// { head = 0 }
head { sub(/^\/\//, "///") }
{ print }
