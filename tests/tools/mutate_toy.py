#!/usr/bin/python3
"""usage: mutate_toy.py SOURCE-FOLDER
tools/mutate on a project of three small sources, of which one is not tested: what it finds, refuses, and leaves as it was."""
import re
import subprocess
import sys
import tempfile
from pathlib import Path

tool = Path(sys.argv[1]) / "tools" / "mutate"
try:
    from clang import cindex
    cindex.Index.create()
except Exception:  # the package, or the library behind it
    print("skipped: no python3-clang")
    sys.exit(77)

FILES = {
    ".gitignore": "build/\n",
    "CMakePresets.json": '{"version": 6, "configurePresets": [{"name": "release", "generator": "Ninja", '
                         '"binaryDir": "${sourceDir}/build/release", "cacheVariables": {"CMAKE_BUILD_TYPE": "Release"}}]}\n',
    "CMakeLists.txt": """cmake_minimum_required(VERSION 3.25)
project(toy LANGUAGES CXX)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_CXX_STANDARD 20)
add_library(toy STATIC toy/area.cpp toy/half.cpp toy/length.cpp)
target_include_directories(toy PUBLIC ${CMAKE_SOURCE_DIR})
target_compile_options(toy PRIVATE -Wall -Werror)
add_subdirectory(tests)
""",
    "tests/CMakeLists.txt": "add_executable(test_toy toy/test_area.cpp)\ntarget_link_libraries(test_toy toy)\n",
    "toy/shapes.h": "#pragma once\n#include <optional>\ndouble area(double a, double b);\nint sum_to(int n);\n"
                    "double length(double a, double b);\ndouble half(const std::optional<double>& a, bool wanted);\n",
    "toy/area.cpp": """#include "toy/shapes.h"

double area(double a, double b) {
  if (a < 0.0) return 0.0;
  return a * b;
}

int sum_to(int n) {
  int sum = 0;
  while (n > 0) {
    sum += n;
    n -= 1;
  }
  return sum;
}
""",
    "toy/half.cpp": """#include "toy/shapes.h"

double half(const std::optional<double>& a, bool wanted) {
  if (!a || !wanted) return 0.0;
  return 0.5 * a.value();
}
""",
    "toy/length.cpp": """#include "toy/shapes.h"

double length(double a, double b) {
  const double unused_if_left_out = 2.0 * a;
  return unused_if_left_out + b;
}
""",
    # Every change of area.cpp and half.cpp that can be noticed is.
    "tests/toy/test_area.cpp": """#include "toy/shapes.h"

int main() {
  if (area(3.0, 2.0) != 6.0 || area(-3.0, 2.0) != 0.0 || area(0.5, 4.0) != 2.0 || area(1.5, 4.0) != 6.0) return 1;
  if (half({}, true) != 0.0 || half(3.0, true) != 1.5 || half(3.0, false) != 0.0) return 1;
  return sum_to(4) != 10 || sum_to(3) != 6 || sum_to(1) != 1 || sum_to(0) != 0;
}
""",
}

work = tempfile.TemporaryDirectory()
root = Path(work.name)


def git(*words):
    return subprocess.run(["git", "-c", "user.name=toy", "-c", "user.email=toy@localhost", *words], cwd=root, check=True,
                          stdout=subprocess.PIPE, text=True).stdout


def mutate(*words, status):
    done = subprocess.run([tool, "--root", root, "--limit", "1", *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert done.returncode == status, f"{words}: status {done.returncode}, expected {status}\n{done.stdout}{done.stderr}"
    assert not git("status", "--porcelain"), "the checkout has changed"
    return done


def survivors(text):
    return re.findall(r"^\| (toy/\w+\.cpp):(\d+) \| `(.*?)` \| `(.*?)` \|$", text, re.MULTILINE)


for name, text in FILES.items():
    (root / name).parent.mkdir(parents=True, exist_ok=True)
    (root / name).write_text(text)
git("init", "-q")
git("add", ".")
git("commit", "-qm", "toy")

# The draw is the seed's.
first, again, other = (mutate("toy", "12", "--seed", s, "--list", status=0).stdout for s in ("5", "5", "6"))
assert first == again and first != other

# What is tested is noticed, an endless loop too; at 0 a bound that is none, a < 0.0 or a <= 0.0, would be as good.
done = mutate("toy/area.cpp", "1000", "--seed", "1", "-o", root / "build" / "table.md", status=0)
assert (root / "build" / "table.md").read_text() == done.stdout
assert re.search(r"Score \d+ % \(95 % interval \d+ to 100 %\)|Score \d+ %", done.stdout), done.stdout
assert "time limit" in done.stderr, done.stderr
left = survivors(done.stdout)
assert all(line == "4" for _, line, _, _ in left), left

# A truth value that was made of something else stays one: half({}, true) is no half of anything.
done = mutate("toy/half.cpp", "1000", status=0)
assert not survivors(done.stdout), done.stdout

# What is not tested survives, whatever is left unused.
done = mutate("toy/length.cpp", "1000", status=4)
left = survivors(done.stdout)
assert "Score 0 % (95 % interval 0 to " in done.stdout, done.stdout
assert ("toy/length.cpp", "5", "return unused_if_left_out + b;", "return (b);") in left, left
assert ("toy/length.cpp", "4", "const double unused_if_left_out = 2.0 * a;", "const double unused_if_left_out = (a);") in left, left
mutate("toy/length.cpp", "3", "--least", "0", status=0)

# Given by hand: what the compiler makes the same of, refuses, and what is not there.
given = root / "build" / "given.txt"
given.write_text("# a comment\ntoy/length.cpp | 2.0 * a | a + a\ntoy/length.cpp | 2.0 * a | nothing\n")
done = mutate("toy", "--given", given, status=0)
assert "1 equivalent, 1 refused" in done.stdout, done.stdout
given.write_text("toy/length.cpp | 3.0 * a | a\n")
assert "given.txt:1: '3.0 * a' stands 0 times in toy/length.cpp, expected once" in mutate("toy", "--given", given, status=1).stderr

# Changed lines alone; none is no failure.
(root / "toy/length.cpp").write_text(FILES["toy/length.cpp"].replace("+ b", "- b"))
git("commit", "-qam", "changed")
done = mutate("toy", "50", "--changed", "HEAD~1", "--list", status=0)
assert set(re.findall(r"^(toy/\S+)  ", done.stdout, re.MULTILINE)) == {"toy/length.cpp:5"}, done.stdout
assert mutate("--changed", "HEAD~1", "--list", status=0).stdout
assert "no change was left to try" in mutate("toy", "50", "--changed", "HEAD", status=0).stdout

# Wrong use is one clear sentence.
assert "nowhere: no such room, folder or source" in mutate("nowhere", status=1).stderr
assert "N: found 0, expected at least 1" in mutate("toy", "0", status=1).stderr
(root / "tests/toy/test_area.cpp").write_text("int main() { return 1; }\n")
git("commit", "-qam", "fails")
assert "fails without any change" in mutate("toy", "3", status=1).stderr
