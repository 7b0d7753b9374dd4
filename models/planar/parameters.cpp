#include "models/planar/parameters.h"
