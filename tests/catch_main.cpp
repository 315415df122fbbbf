/// The main function of every test program. SystemC's library refers to `sc_main`, which a program with a main of its own never calls.
#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>

extern "C" int sc_main(int, char**) { return 0; }
