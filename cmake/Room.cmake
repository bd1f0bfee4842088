# What every room shares: the language, the warnings, ccache, and one function that makes a library of a folder.
include_guard(GLOBAL)

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release)
endif()

option(GLIDELAB_WERROR "Treat warnings as errors" OFF)
option(GLIDELAB_UNITY "Compile each folder as one unit: all from nothing in half the time, but a changed source recompiles its folder" ON)
option(GLIDELAB_SANITIZE "Build with the address and undefined-behaviour sanitizers" OFF)
option(GLIDELAB_FUZZ "Build libFuzzer targets of the readers (tests/fuzz; clang only)" OFF)

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # Served in every checkout, and with a precompiled header (which ccache by itself takes for a reason to give up).
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime
                                  CCACHE_BASEDIR=${CMAKE_SOURCE_DIR} CCACHE_NOHASHDIR=1 ${CCACHE_PROGRAM})
endif()

# g++ collects garbage whenever its heap has grown by a part; with templates as here that is an eighth of all time. A unit takes 2 GB at most.
add_compile_options("$<$<CXX_COMPILER_ID:GNU>:SHELL:--param ggc-min-heapsize=1048576>")

get_filename_component(GLIDELAB_ROOT ${CMAKE_CURRENT_LIST_DIR}/.. ABSOLUTE)

if(GLIDELAB_SANITIZE)
  add_compile_options(-fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=address,undefined)
  # A number that does not fit into the whole number it becomes: clang takes it for undefined behaviour, g++ only when asked.
  add_compile_options($<$<CXX_COMPILER_ID:GNU>:-fsanitize=float-cast-overflow>)
  # What the sanitizers add makes g++ take members of the standard library's own <regex> for unset.
  add_compile_options($<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
endif()

if(GLIDELAB_FUZZ)
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()

function(glidelab_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
                                           -Wnon-virtual-dtor -Wold-style-cast -Woverloaded-virtual)
  # Through a precompiled header g++ 12 sees into the concatenation of two std::string and takes it for an overrun.
  target_compile_options(${target} PRIVATE "$<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds;-Wno-stringop-overflow;-Wno-stringop-overread;-Wno-restrict>")
  if(GLIDELAB_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()

# glidelab_precompile(TARGET FROM <target> | OWN <header>): what nearly every file includes of the libraries is compiled once, with the
# target that OWNs it, and read by all others. Named <so>, the same in every checkout, as a compiler cache needs it.
function(glidelab_precompile target)
  cmake_parse_arguments(PRECOMPILE "" "FROM;OWN" "" ${ARGN})
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
  if(PRECOMPILE_OWN)
    target_precompile_headers(${target} PRIVATE <${PRECOMPILE_OWN}>)
  else()
    target_precompile_headers(${target} REUSE_FROM ${PRECOMPILE_FROM})
  endif()
endfunction()

# glidelab_unity(TARGET SOURCES <sources…> [TOGETHER <units…>]): a folder's sources are compiled together, where GLIDELAB_UNITY is
# on; a unit "a b/c" puts the sources of those folders together too. Every unit reads the precompiled header and what its folders
# include anew, one to three seconds, so that small folders share one.
function(glidelab_unity target)
  cmake_parse_arguments(UNITY "" "" "SOURCES;TOGETHER" ${ARGN})
  if(NOT GLIDELAB_UNITY)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  foreach(source ${UNITY_SOURCES})
    get_filename_component(folder ${source} DIRECTORY)
    file(RELATIVE_PATH within ${CMAKE_CURRENT_SOURCE_DIR} ${folder})
    if(within STREQUAL "")
      set(within .)
    endif()
    file(RELATIVE_PATH folder ${GLIDELAB_ROOT} ${folder})
    string(MAKE_C_IDENTIFIER "${folder}" group)
    foreach(unit IN LISTS UNITY_TOGETHER)
      separate_arguments(folders UNIX_COMMAND "${unit}")
      if(within IN_LIST folders)
        string(MAKE_C_IDENTIFIER "${target}_${unit}" group)
      endif()
    endforeach()
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${group})
  endforeach()
endfunction()

# glidelab_objects(TARGET [WORDS] SOURCES <sources…> TOGETHER <units…> LINK <public libraries…>): how every source of a room is compiled.
function(glidelab_objects target)
  cmake_parse_arguments(OBJECTS "WORDS" "" "SOURCES;TOGETHER;LINK" ${ARGN})
  target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${GLIDELAB_ROOT}> $<INSTALL_INTERFACE:include/glidelab>)
  target_link_libraries(${target} PUBLIC ${OBJECTS_LINK})
  # One set of objects serves the program and the Python module, so that both give the same bits.
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_compile_options(${target} PRIVATE -fno-semantic-interposition)
  glidelab_warnings(${target})
  glidelab_unity(${target} SOURCES ${OBJECTS_SOURCES} TOGETHER ${OBJECTS_TOGETHER})
  set(owner glidelab_base)
  if(OBJECTS_WORDS)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
    set(owner glidelab_base_words)  # of other options, so that it needs a header of its own
  endif()
  if(target STREQUAL owner)
    glidelab_precompile(${target} OWN cmake/precompiled.h)
  else()
    glidelab_precompile(${target} FROM ${owner})
  endif()
endfunction()

# glidelab_room(NAME [WORDS] [FOLDERS <folders…>] [WORDS_IN <folders…>] [TOGETHER <units…>] LINK <public libraries…>): all sources of the folders
# (default: this one) make glidelab::NAME, included as "room/suite/header.h". WORDS: a room that writes tables, pages and messages or has
# others compute, and computes nothing at length itself; it is compiled with -O1, in two thirds of the time. WORDS_IN: these folders
# alone are ("." for the room's own sources).
function(glidelab_room name)
  cmake_parse_arguments(ROOM "WORDS" "" "FOLDERS;WORDS_IN;TOGETHER;LINK" ${ARGN})
  if(NOT ROOM_FOLDERS)
    set(ROOM_FOLDERS .)
  endif()
  set(patterns)
  foreach(folder IN LISTS ROOM_FOLDERS)
    get_filename_component(path ${CMAKE_CURRENT_SOURCE_DIR}/${folder} ABSOLUTE)
    list(APPEND patterns ${path}/*.cpp)
  endforeach()
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${patterns})
  list(FILTER sources EXCLUDE REGEX "/main\\.cpp$")
  set(words)
  foreach(folder IN LISTS ROOM_WORDS_IN)
    get_filename_component(path ${CMAKE_CURRENT_SOURCE_DIR}/${folder} ABSOLUTE)
    set(before ${words})
    foreach(source IN LISTS sources)
      get_filename_component(of ${source} DIRECTORY)
      if(of STREQUAL path)
        list(APPEND words ${source})
      endif()
    endforeach()
    if("${words}" STREQUAL "${before}")
      message(FATAL_ERROR "glidelab_room(${name}): WORDS_IN ${folder} holds no source")
    endif()
  endforeach()
  if(words)
    list(REMOVE_ITEM sources ${words})
    add_library(glidelab_${name}_words OBJECT ${words})
    glidelab_objects(glidelab_${name}_words WORDS SOURCES ${words} TOGETHER ${ROOM_TOGETHER} LINK ${ROOM_LINK})
  endif()
  add_library(glidelab_${name} STATIC ${sources})
  add_library(glidelab::${name} ALIAS glidelab_${name})
  if(words)
    target_sources(glidelab_${name} PRIVATE $<TARGET_OBJECTS:glidelab_${name}_words>)
  endif()
  if(ROOM_WORDS)
    set(words_all WORDS)
  endif()
  glidelab_objects(glidelab_${name} ${words_all} SOURCES ${sources} TOGETHER ${ROOM_TOGETHER} LINK ${ROOM_LINK})
endfunction()
