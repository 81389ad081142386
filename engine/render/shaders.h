// The files of shaders/, embedded by the build. Each program puts `common` before its own.
#pragma once

namespace toile::render::shaders {

extern const char* const k_common;
extern const char* const k_mesh_vertex;
extern const char* const k_mesh_fragment;
extern const char* const k_depth_vertex;
extern const char* const k_depth_fragment;
extern const char* const k_screen_vertex;
extern const char* const k_gather_fragment;
extern const char* const k_visibility_fragment;
extern const char* const k_blur_fragment;
extern const char* const k_shading;
extern const char* const k_lighting;
extern const char* const k_classify_fragment;
extern const char* const k_final_fragment;
extern const char* const k_canvas_vertex;
extern const char* const k_canvas_fragment;

} // namespace toile::render::shaders
