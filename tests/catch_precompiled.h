/// What every test includes, compiled once (tests/CMakeLists.txt).
#pragma once
#include "cmake/precompiled.h"
#include "tests/catch.h"
