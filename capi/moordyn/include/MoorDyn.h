/* First interface of MoorDyn, one system per process, as moorline provides it: part of MoorDyn2.h. */
#ifndef MOORLINE_MOORDYN_H
#define MOORLINE_MOORDYN_H

#include "MoorDyn2.h"

#endif
