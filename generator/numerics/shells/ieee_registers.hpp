#if defined __FLT_EVAL_METHOD__ && (__FLT_EVAL_METHOD__ < 0 || __FLT_EVAL_METHOD__ == 2)
#error "numbers must not be kept in wider registers: compile with -msse2 -mfpmath=sse"
#endif
