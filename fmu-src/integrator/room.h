/* Where SUNDIALS takes its memory: the room of the solver that is being made. Plain C, since all of SUNDIALS' sources
 * are compiled with this header in front (cmake/sundials.cmake); they stay as they are. No paper equation, no frame.
 *
 * SUNDIALS 7.1.1 does not survive every failed allocation. Out of a room that is large enough none can fail. */
#ifndef WHEEL_ROOM_H
#define WHEEL_ROOM_H

#include <stdlib.h>

/* Null outside the making of a solver. */
void* wheel_room_malloc(size_t size);
void* wheel_room_calloc(size_t count, size_t size);
/* Does nothing: a room is given up as a whole. */
void wheel_room_free(void* piece);

#ifdef WHEEL_INSIDE_SUNDIALS
#define malloc wheel_room_malloc
#define calloc wheel_room_calloc
#define free wheel_room_free
#endif

#ifdef WHEEL_INSIDE_CVODE
/* CVODE writes each message into memory of its own first; integrator.cpp has a cvProcessError that needs none. */
#pragma weak cvProcessError
#endif

#endif
