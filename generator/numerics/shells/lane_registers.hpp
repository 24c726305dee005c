#ifndef HAMGEN_REGISTERS  // what is compiled for other registers does not mix with this
#if defined __AVX512F__
#define HAMGEN_REGISTERS registers_of_8
#elif defined __AVX2__
#define HAMGEN_REGISTERS registers_of_4
#else
#define HAMGEN_REGISTERS registers_of_2
#endif
#endif
