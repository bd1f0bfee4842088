#include "tests/catch_precompiled.h"
