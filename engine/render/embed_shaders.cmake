# Writes OUT: a C++ source with one constant per file of SHADERS.
set(text "#include \"render/shaders.h\"\n\nnamespace toile::render::shaders {\n")
foreach(file ${SHADERS})
    get_filename_component(name "${file}" NAME_WE)
    file(READ "${file}" content)
    string(APPEND text "const char* const k_${name} = R\"glsl(${content})glsl\";\n")
endforeach()
string(APPEND text "} // namespace toile::render::shaders\n")
file(WRITE "${OUT}" "${text}")
