// The table of DOP853 as JSON.
#pragma once

// All rows as lists of [stage, weight].
void print_table();
