#ifdef __clang__  // which has no macro for -fassociative-math
#pragma float_control(push)
#pragma clang fp reassociate(off)
#endif
