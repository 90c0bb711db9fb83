/* Opens the library of an FMU and finds its functions: for every C program that drives the wheel. No paper equation. */
#ifndef SUPPORT_LOAD_LIBRARY_H
#define SUPPORT_LOAD_LIBRARY_H

#include <stdio.h>
#include <stdlib.h>

#ifdef _WIN32
#include <windows.h>
static inline void* open_library(const char* path) { return (void*)LoadLibraryA(path); }
static inline void* find_symbol(void* library, const char* name) {
  return (void*)GetProcAddress((HMODULE)library, name);
}
#else
#include <dlfcn.h>
static inline void* open_library(const char* path) { return dlopen(path, RTLD_NOW | RTLD_LOCAL); }
static inline void* find_symbol(void* library, const char* name) { return dlsym(library, name); }
#endif

/* Fills `functions`, a struct of function pointers in the order of `names`. Ends the program with a sentence where the
 * library or one of them is missing. */
static inline void load_functions(const char* path, const char* const names[], unsigned count, void* functions) {
  void* library = open_library(path);
  if (!library) {
    fprintf(stderr, "%s could not be loaded\n", path);
    exit(2);
  }
  for (unsigned i = 0; i < count; ++i) {
    void* symbol = find_symbol(library, names[i]);
    if (!symbol) {
      fprintf(stderr, "%s: %s is missing\n", path, names[i]);
      exit(2);
    }
    ((void**)functions)[i] = symbol;
  }
}

#endif
