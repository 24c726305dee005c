#ifdef __clang__
#pragma float_control(pop)
#endif
