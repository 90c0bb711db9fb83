/* The wheel inside a web page: what a page cannot give to fmi2Instantiate itself, a record of C functions. Messages go
   to the page's function `log`; memory is the module's own. No part of the paper. */
#include <stdlib.h>

#include "fmi2FunctionTypes.h"

__attribute__((import_module("page"), import_name("log"))) void page_log(int status, const char* category,
                                                                         const char* message);

static void forward(fmi2ComponentEnvironment environment, fmi2String instance, fmi2Status status, fmi2String category,
                    fmi2String message, ...) {
  (void)environment, (void)instance;
  page_log(status, category, message);
}

/* The callbacks of every instance; they outlive all of them. */
const fmi2CallbackFunctions* page_callbacks(void) {
  static const fmi2CallbackFunctions callbacks = {forward, calloc, free, NULL, NULL};
  return &callbacks;
}
