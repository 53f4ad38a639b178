include(AmbientInstall)

# ambient_add_box(NAME [COLD] [SOURCES ...] [DEPENDS ...] [PRIVATE_DEPENDS ...] [PRECISION float32|float64])
#
# One library target per box of docs/architecture.md. A box without sources is header-only. DEPENDS are public; the
# linker enforces who may include whom. PRIVATE_DEPENDS are header-only libraries that the sources alone see: they
# do not reach the installed package. PRECISION: the box includes Bullet's headers of that precision, and everything
# that links it is compiled with BULLET_AMBIENT_FLOAT64 = 0 or 1. COLD: its own work takes no time; it is optimised little,
# which compiles faster.
function(ambient_add_box name)
  cmake_parse_arguments(BOX "COLD" "PRECISION" "SOURCES;DEPENDS;PRIVATE_DEPENDS" ${ARGN})
  if(BOX_SOURCES)
    add_library(${name} ${BOX_SOURCES})
    set(scope PUBLIC)
    ambient_set_compile_options(${name})
    if(BOX_COLD)
      ambient_optimise_little(${name})
    endif()
    foreach(dependency IN LISTS BOX_PRIVATE_DEPENDS)
      target_link_libraries(${name} PRIVATE $<BUILD_INTERFACE:${dependency}>)
    endforeach()
  else()
    add_library(${name} INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(BulletAmbient::${name} ALIAS ${name})
  # The library files carry the project's name, whatever the box is called.
  string(REGEX REPLACE "^(bullet_)?ambient" "bullet_ambient" output_name ${name})
  set_target_properties(${name} PROPERTIES OUTPUT_NAME ${output_name})
  if(BOX_SOURCES)
    # Before 1.0 every minor version may need programs to be built anew.
    set_target_properties(${name} PROPERTIES VERSION ${BulletAmbient_VERSION}
      SOVERSION ${BulletAmbient_VERSION_MAJOR}.${BulletAmbient_VERSION_MINOR})
  endif()
  target_compile_features(${name} ${scope} cxx_std_17)
  target_include_directories(${name} ${scope} $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
  target_link_libraries(${name} ${scope} ${BOX_DEPENDS})
  if(BOX_PRECISION)
    ambient_set_precision(${name} ${scope} ${BOX_PRECISION})
  endif()
  ambient_install_box(${name} ${BOX_PRECISION})
endfunction()

# ambient_add_kernels(BOX SOURCES ... DEPENDS ...): adds to the box sources that are compiled once per instruction set, each
# alone, since they share the names of their vectors. The program chooses one when it runs; all give the same bits.
function(ambient_add_kernels box)
  cmake_parse_arguments(KERNELS "" "" "SOURCES;DEPENDS" ${ARGN})
  set(in_vectors "vector_loop:4096:noalign$<COMMA>libcall:-1:noalign")
  set(instruction_sets Baseline Avx2)
  if(BULLET_AMBIENT_AVX512)
    list(APPEND instruction_sets Avx512)
  endif()
  foreach(set IN LISTS instruction_sets)
    string(TOLOWER ${box}_${set} kernels)
    add_library(${kernels} OBJECT ${KERNELS_SOURCES})
    set_target_properties(${kernels} PROPERTIES UNITY_BUILD OFF)
    if(BUILD_SHARED_LIBS)
      set_target_properties(${kernels} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    endif()
    ambient_set_compile_options(${kernels})
    target_compile_definitions(${kernels} PRIVATE AMBIENT_INSTRUCTION_SET=${set})
    target_link_libraries(${kernels} PRIVATE ${KERNELS_DEPENDS})
    if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|amd64|AMD64)$")
      target_compile_options(${kernels} PRIVATE
        $<$<STREQUAL:${set},Avx2>:-mavx2;-mfma> $<$<STREQUAL:${set},Avx512>:-mavx512f;-mavx512dq>
        # GCC fills and copies some hundred bytes by "rep stos" and "rep movs", which take as long to start as a kernel's loop.
        $<$<CXX_COMPILER_ID:GNU>:-mmemset-strategy=${in_vectors};-mmemcpy-strategy=${in_vectors}>)
    endif()
    target_sources(${box} PRIVATE $<TARGET_OBJECTS:${kernels}>)
  endforeach()
endfunction()

# ambient_set_instruction_sets(SOURCES...): tells sources of this folder for which instruction sets there are kernels. They
# are compiled alone, so that the others do not depend on that.
function(ambient_set_instruction_sets)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON
    COMPILE_DEFINITIONS BULLET_AMBIENT_AVX512=$<BOOL:${BULLET_AMBIENT_AVX512}>)
endfunction()

# No target can link boxes of both precisions: CMake refuses to generate it.
function(ambient_set_precision name scope precision)
  target_link_libraries(${name} ${scope} BulletAmbient::bullet-${precision})
  string(COMPARE EQUAL ${precision} float64 is_float64)
  target_compile_definitions(${name} ${scope} BULLET_AMBIENT_FLOAT64=${is_float64})
  set_target_properties(${name} PROPERTIES
    BULLET_PRECISION ${precision}
    INTERFACE_BULLET_PRECISION ${precision}
    COMPATIBLE_INTERFACE_STRING BULLET_PRECISION)
endfunction()

# ambient_add_bullet_box(NAME SOURCES ... [DEPENDS ...] [PRIVATE_DEPENDS ...]): the same sources once for each precision of
# Bullet that is built: NAME for float, NAME-float64 for double.
function(ambient_add_bullet_box name)
  foreach(precision IN LISTS BULLET_AMBIENT_PRECISIONS)
    ambient_name_for_precision(target ${name} ${precision})
    ambient_add_box(${target} PRECISION ${precision} ${ARGN})
  endforeach()
endfunction()

# ambient_name_for_precision(OUT NAME float32|float64): NAME or NAME-float64, as Debian names the two Bullets.
function(ambient_name_for_precision out name precision)
  if(precision STREQUAL "float64")
    set(${out} ${name}-float64 PARENT_SCOPE)
  else()
    set(${out} ${name} PARENT_SCOPE)
  endif()
endfunction()

# For what is compiled more often than it computes; it overrides the -O3 of Release.
function(ambient_optimise_little name)
  target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# ambient_sanitize_less(NAME SANITIZERS): a target of the preset asan without these sanitizers, unless BULLET_AMBIENT_SANITIZE_ALL
# is on.
function(ambient_sanitize_less name sanitizers)
  if(CMAKE_CXX_FLAGS MATCHES "-fsanitize=address" AND NOT BULLET_AMBIENT_SANITIZE_ALL)
    target_compile_options(${name} PRIVATE -fno-sanitize=${sanitizers})
  endif()
endfunction()

# Options every target of this project is compiled with. Sources that are compiled together may use a local name that
# another one has for itself: shadows are looked for where each is compiled alone. No contraction to fused multiply-add:
# the same input gives the same bits with every instruction set.
function(ambient_set_compile_options name)
  target_compile_options(${name} PRIVATE -Wall -Wextra -Wpedantic -Wconversion -Wno-sign-conversion
    $<$<NOT:$<BOOL:$<TARGET_PROPERTY:UNITY_BUILD>>>:-Wshadow> -ffp-contract=off $<$<BOOL:${BULLET_AMBIENT_WARNINGS_AS_ERRORS}>:-Werror>)
endfunction()
