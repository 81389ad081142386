# Compiler settings, and the four functions that every folder's CMakeLists uses.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_C_STANDARD 11)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/bin")
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -g1 -DNDEBUG")

option(TOILE_SANITIZE "Build with AddressSanitizer and UndefinedBehaviorSanitizer" OFF)
option(TOILE_PRECOMPILED "Parse Eigen and the standard library once for all sources" ON)

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
    set(CMAKE_C_COMPILER_LAUNCHER "${CCACHE_PROGRAM}")
    # With precompiled headers ccache hits only with these two settings.
    set(CMAKE_CXX_COMPILER_LAUNCHER
        env CCACHE_SLOPPINESS=pch_defines,time_macros "${CCACHE_PROGRAM}")
    add_compile_options($<$<COMPILE_LANGUAGE:CXX>:-fpch-preprocess>)
endif()

# The bit-for-bit promise rests on these: one instruction set, no contraction, no fast-math.
add_compile_options(-march=x86-64-v3 -mtune=generic -ffp-contract=off)
add_compile_options(-Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion -fdiagnostics-color=always)
add_link_options(-Wl,--as-needed)
if(TOILE_SANITIZE)
    set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O1 -g1")
    add_compile_options(-fsanitize=address,undefined -fno-sanitize-recover=undefined
                        -fno-omit-frame-pointer)
    add_link_options(-fsanitize=address,undefined)
endif()

# Eigen and the standard library are a third of the compile time of a layer's source: they are
# parsed once, for all layers, plugins and the program (tests, mostly GoogleTest, gain nothing).
# Sources still include what they use: scripts/lint, whose clang cannot read GCC's, does without.
if(TOILE_PRECOMPILED)
    add_library(toile_precompiled OBJECT "${CMAKE_SOURCE_DIR}/scripts/cmake/precompiled.cpp")
    target_link_libraries(toile_precompiled PRIVATE Eigen3::Eigen)
    target_precompile_headers(toile_precompiled PRIVATE
        <Eigen/Core> <Eigen/Geometry> <algorithm> <array> <cmath> <cstdint> <filesystem> <fstream>
        <functional> <map> <memory> <numbers> <optional> <set> <span> <sstream> <string>
        <string_view> <vector>)
endif()
set(CMAKE_CXX_COMPILE_OPTIONS_PIE -fPIC) # the flags must be those of the precompiled headers
function(toile_use_precompiled target)
    if(TARGET toile_precompiled)
        target_precompile_headers(${target} REUSE_FROM toile_precompiled)
    endif()
endfunction()

# toile_add_layer(name DEPENDS layer... [LINK target...]): one folder of engine/ as a static
# library from all its .cpp files. DEPENDS must be arrows of tests/layers (a test holds them).
function(toile_add_layer name)
    cmake_parse_arguments(ARG "" "" "DEPENDS;LINK;LINK_PRIVATE" ${ARGN})
    file(GLOB sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/*.cpp")
    list(TRANSFORM ARG_DEPENDS PREPEND "toile_" OUTPUT_VARIABLE layers)
    if(sources)
        add_library(toile_${name} STATIC ${sources})
        target_include_directories(toile_${name} PUBLIC "${CMAKE_SOURCE_DIR}/engine")
        target_link_libraries(toile_${name} PUBLIC ${layers} ${ARG_LINK} PRIVATE ${ARG_LINK_PRIVATE})
        toile_use_precompiled(toile_${name})
    else()
        add_library(toile_${name} INTERFACE)
        target_include_directories(toile_${name} INTERFACE "${CMAKE_SOURCE_DIR}/engine")
        target_link_libraries(toile_${name} INTERFACE ${layers} ${ARG_LINK})
    endif()
endfunction()

# Target stock_plugins: every loadable module of plugins/.
add_custom_target(stock_plugins)

# toile_add_plugin(name [LINK target...] [SANITIZED_TESTS file...]): plugins/<name> as an algorithm
# library (every .cpp but entry.cpp), a loadable module (entry.cpp) laid out as bin/plugins/<name>/
# with its manifest, and a test program from tests/*_test.cpp. SANITIZED_TESTS are those of them that
# read files from outside: a program of their own, also run under the sanitizers.
function(toile_add_plugin name)
    cmake_parse_arguments(ARG "" "" "LINK;TEST_LINK;SANITIZED_TESTS" ${ARGN})
    file(GLOB sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/*.cpp")
    list(REMOVE_ITEM sources "${CMAKE_CURRENT_SOURCE_DIR}/entry.cpp")
    if(sources)
        add_library(${name}_algorithm STATIC ${sources})
        toile_use_precompiled(${name}_algorithm)
        set(scope PUBLIC)
    else()
        add_library(${name}_algorithm INTERFACE)
        set(scope INTERFACE)
    endif()
    target_include_directories(${name}_algorithm ${scope} "${CMAKE_SOURCE_DIR}/plugins")
    target_link_libraries(${name}_algorithm ${scope} toile_abi ${ARG_LINK})

    set(out "${CMAKE_BINARY_DIR}/bin/plugins/${name}")
    add_library(${name} MODULE entry.cpp)
    target_link_libraries(${name} PRIVATE ${name}_algorithm toile_sdk)
    toile_use_precompiled(${name})
    if(NOT TOILE_SANITIZE)
        target_link_options(${name} PRIVATE -Wl,-z,defs)
    endif()
    target_link_options(${name} PRIVATE
        "-Wl,--version-script=${CMAKE_SOURCE_DIR}/scripts/cmake/plugin_exports.map")
    set_property(TARGET ${name} APPEND PROPERTY LINK_DEPENDS
        "${CMAKE_SOURCE_DIR}/scripts/cmake/plugin_exports.map")
    set_target_properties(${name} PROPERTIES LIBRARY_OUTPUT_DIRECTORY "${out}")
    file(GLOB_RECURSE beside CONFIGURE_DEPENDS RELATIVE "${CMAKE_CURRENT_SOURCE_DIR}"
         "${CMAKE_CURRENT_SOURCE_DIR}/plugin.json" "${CMAKE_CURRENT_SOURCE_DIR}/sample.*"
         "${CMAKE_CURRENT_SOURCE_DIR}/sample/*" "${CMAKE_CURRENT_SOURCE_DIR}/*.forest")
    foreach(file ${beside})
        configure_file("${file}" "${out}/${file}" COPYONLY)
    endforeach()
    add_dependencies(stock_plugins ${name})

    file(GLOB tests CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/tests/*_test.cpp")
    if(ARG_SANITIZED_TESTS)
        list(TRANSFORM ARG_SANITIZED_TESTS PREPEND "${CMAKE_CURRENT_SOURCE_DIR}/tests/")
        list(REMOVE_ITEM tests ${ARG_SANITIZED_TESTS})
        toile_add_test(plugin_${name}_files SOURCES ${ARG_SANITIZED_TESTS}
                       LINK ${name}_algorithm SANITIZED)
    endif()
    if(tests)
        toile_add_test(plugin_${name} LABEL plugin SOURCES ${tests}
                       LINK ${name}_algorithm ${ARG_TEST_LINK})
    endif()
endfunction()

# toile_add_test(name SOURCES ... LINK ... [LABEL label] [SANITIZED]): one GoogleTest program; ctest
# lists its cases one by one. SANITIZED ones are also built and run by scripts/test-sanitized under
# the sanitize preset (target sanitized_tests, label sanitized).
add_custom_target(sanitized_tests)
function(toile_add_test name)
    cmake_parse_arguments(ARG "SANITIZED" "LABEL;TIMEOUT" "SOURCES;LINK" ${ARGN})
    if(NOT ARG_LABEL)
        set(ARG_LABEL unit)
    endif()
    if(NOT ARG_TIMEOUT)
        set(ARG_TIMEOUT 300)
    endif()
    add_executable(${name}_test ${ARG_SOURCES})
    target_include_directories(${name}_test PRIVATE "${CMAKE_SOURCE_DIR}/tests")
    target_link_libraries(${name}_test PRIVATE ${ARG_LINK} toile_test_support
                          GTest::gmock GTest::gtest_main)
    if(ARG_SANITIZED)
        set(ARG_LABEL sanitized) # a list would not survive gtest_discover_tests
        add_dependencies(sanitized_tests ${name}_test)
    endif()
    gtest_discover_tests(${name}_test TEST_PREFIX "${name}." DISCOVERY_MODE PRE_TEST
                         PROPERTIES LABELS "${ARG_LABEL}" TIMEOUT ${ARG_TIMEOUT})
endfunction()

# toile_link_data(): avatars/ and garments/ stand beside the program, as when installed.
function(toile_link_data)
    file(MAKE_DIRECTORY "${CMAKE_BINARY_DIR}/bin")
    foreach(folder avatars garments)
        file(CREATE_LINK "${CMAKE_SOURCE_DIR}/${folder}" "${CMAKE_BINARY_DIR}/bin/${folder}" SYMBOLIC)
    endforeach()
    foreach(folder freesewing report)
        file(CREATE_LINK "${CMAKE_SOURCE_DIR}/engine/apps/${folder}" "${CMAKE_BINARY_DIR}/bin/${folder}"
             SYMBOLIC)
    endforeach()
    file(CREATE_LINK "${CMAKE_SOURCE_DIR}/engine/apps/kiosk/data" "${CMAKE_BINARY_DIR}/bin/kiosk" SYMBOLIC)
endfunction()
