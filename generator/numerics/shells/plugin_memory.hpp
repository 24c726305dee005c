// Where an object is made.  The header <new> says it too, but takes the compiler as long to read as
// all the rest.
#ifndef HAMGEN_PLACE
#define HAMGEN_PLACE
struct hamgen_place {
  void* memory;
};
inline void* operator new(decltype(sizeof 0), hamgen_place place) { return place.memory; }
#endif
