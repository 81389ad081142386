// The source that CMake wants for precompiled headers (ToileBuild.cmake).
