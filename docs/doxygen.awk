# The comments of the public headers as Doxygen reads them: a line comment belongs to what follows,
# one behind a declaration to that, and the first of a file to the file.
/operator(==|<=>).*= default/ { next }
# An enumeration of C cannot be documented elsewhere.
/^enum hamgen_status/ { print "/** What becomes of a call of hamgen_plugin::advance. */" }
NR == 1 && /^\/\/ / { sub(/^\/\/ /, "/// \\file\n/// "); in_head = 1; print; next }
NR == 1 && /^\/\*/ { sub(/^\/\*/, "/** \\file\n"); print; next }
in_head && /^\/\// { sub(/^\/\//, "///"); print; next }
{ in_head = 0 }
/^ *\/\// { match($0, /^ */); sub(/\/\//, is_behind && RLENGTH > 8 ? "///<" : "///"); print; next }
/^ *\/\*/ { sub(/\/\*/, is_behind ? "/**<" : "/**") }
{ is_behind = 0 }
/[;,{}] +\/\/ / { is_behind = sub(/ \/\/ /, " ///< ") && !/{ +\/\// }
/[;,] +\/\*/ { sub(/\/\*/, "/**<") }
{ print }
