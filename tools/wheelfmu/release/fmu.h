/* The functions of the FMU that the C programs call, by FMI's names without "fmi2". No paper equation, no frame. */
#ifndef FMU_H
#define FMU_H

#include <stdio.h>
#include <stdlib.h>

#include "fmi2FunctionTypes.h"
#ifdef __wasi__ /* no libraries to open: the program has the wheel linked in */
#include "fmi2Functions.h"
#elif defined _WIN32
#include <windows.h>
#define OPEN_LIBRARY(path) (void*)LoadLibraryA(path)
#define FIND_SYMBOL(library, name) (void*)GetProcAddress((HMODULE)(library), name)
#else
#include <dlfcn.h>
#define OPEN_LIBRARY(path) dlopen(path, RTLD_NOW | RTLD_LOCAL)
#define FIND_SYMBOL dlsym
#endif

/* clang-format off */
#define FMU_FUNCTIONS(F) \
  F(Instantiate) F(FreeInstance) F(SetupExperiment) F(EnterInitializationMode) F(ExitInitializationMode) \
  F(SetReal) F(SetInteger) F(SetBoolean) F(SetRealInputDerivatives) F(DoStep) F(GetReal)
/* clang-format on */

typedef struct Fmu {
#define MEMBER(name) fmi2##name##TYPE* name;
  FMU_FUNCTIONS(MEMBER)
#undef MEMBER
} Fmu;

/* Out of the library at `path`. Ends the program with a sentence where it or a function is missing. */
static inline Fmu fmu_of(const char* path) {
#ifdef __wasi__
#define LINKED(name) .name = fmi2##name,
  (void)path;
  return (Fmu){FMU_FUNCTIONS(LINKED)};
#undef LINKED
#else
#define NAME(name) "fmi2" #name,
  static const char* const names[] = {FMU_FUNCTIONS(NAME)};
#undef NAME
  Fmu fmu;
  void* const library = OPEN_LIBRARY(path);
  for (unsigned i = 0; i < sizeof names / sizeof *names; ++i) {
    void* const symbol = library ? FIND_SYMBOL(library, names[i]) : NULL;
    if (!symbol) {
      fprintf(stderr, library ? "%s: %s is missing\n" : "%s could not be loaded\n", path, names[i]);
      exit(2);
    }
    ((void**)&fmu)[i] = symbol;
  }
  return fmu;
#endif
}

#endif
