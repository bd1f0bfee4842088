/// Catch2 2.13 (Debian 12) or 3.x behind one name.
#pragma once
#if __has_include(<catch2/catch_all.hpp>)
#include <catch2/catch_all.hpp>
using Catch::Approx;  // 2.13 has it without its namespace
#else
#include <catch2/catch.hpp>
#endif
