#include "engine/jnd.h"
#include "engine/result.h"
