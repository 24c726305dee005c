#if defined __GNUC__ && !defined __clang__  // g++ warns of bounds that are a template's int
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wsign-conversion"
#endif
