/* Layout of ABI 1.0 on 64-bit machines: sizes and offsets of every struct of the boundary. A
 * line that fails means that plugins built before would break: see docs/abi_history.md. */
#include "abi/toile.h"

#ifdef __cplusplus
#define PIN(condition, text) static_assert(condition, text)
#else
#define PIN(condition, text) _Static_assert(condition, text)
#endif
#define SIZE(type, bytes) PIN(sizeof(type) == bytes, "size of " #type)
#define AT(type, field, bytes) PIN(offsetof(type, field) == bytes, "place of " #type "." #field)

SIZE(toile_view, 24);
AT(toile_view, data, 0);
AT(toile_view, count, 8);
AT(toile_view, stride, 12);
AT(toile_view, format, 16);
AT(toile_view, reserved, 20);

SIZE(toile_view_mut, 24);
AT(toile_view_mut, data, 0);
AT(toile_view_mut, count, 8);
AT(toile_view_mut, stride, 12);
AT(toile_view_mut, format, 16);
AT(toile_view_mut, reserved, 20);

SIZE(toile_mesh, 136);
AT(toile_mesh, size, 0);
AT(toile_mesh, reserved, 4);
AT(toile_mesh, positions, 8);
AT(toile_mesh, normals, 32);
AT(toile_mesh, colors, 56);
AT(toile_mesh, triangles, 80);
AT(toile_mesh, corner_coords, 104);
AT(toile_mesh, topology_id, 128);

SIZE(toile_job, 24);
AT(toile_job, size, 0);
AT(toile_job, reserved, 4);
AT(toile_job, job_data, 8);
AT(toile_job, progress, 16);

SIZE(toile_mesh_buffers, 128);
AT(toile_mesh_buffers, size, 0);
AT(toile_mesh_buffers, reserved, 4);
AT(toile_mesh_buffers, positions, 8);
AT(toile_mesh_buffers, normals, 32);
AT(toile_mesh_buffers, colors, 56);
AT(toile_mesh_buffers, triangles, 80);
AT(toile_mesh_buffers, corner_coords, 104);

SIZE(toile_mesh_sink, 32);
AT(toile_mesh_sink, size, 0);
AT(toile_mesh_sink, reserved, 4);
AT(toile_mesh_sink, sink_data, 8);
AT(toile_mesh_sink, begin, 16);
AT(toile_mesh_sink, commit, 24);

SIZE(toile_landmark, 16);
AT(toile_landmark, name, 0);
AT(toile_landmark, vertex, 8);
AT(toile_landmark, reserved, 12);

SIZE(toile_measurement, 16);
AT(toile_measurement, name, 0);
AT(toile_measurement, value, 8);
AT(toile_measurement, confidence, 12);

SIZE(toile_body, 328);
AT(toile_body, size, 0);
AT(toile_body, reserved, 4);
AT(toile_body, revision, 8);
AT(toile_body, model_id, 16);
AT(toile_body, coefficients, 24);
AT(toile_body, rest, 48);
AT(toile_body, rest_joints, 184);
AT(toile_body, joint_indices, 208);
AT(toile_body, joint_weights, 232);
AT(toile_body, part_labels, 256);
AT(toile_body, landmarks, 280);
AT(toile_body, measurements, 304);

SIZE(toile_joint, 56);
AT(toile_joint, position, 0);
AT(toile_joint, rotation, 12);
AT(toile_joint, linear_velocity, 28);
AT(toile_joint, angular_velocity, 40);
AT(toile_joint, confidence, 52);

SIZE(toile_body_state, 104);
AT(toile_body_state, size, 0);
AT(toile_body_state, person_id, 4);
AT(toile_body_state, tracking, 8);
AT(toile_body_state, sequence, 12);
AT(toile_body_state, timestamp_ns, 16);
AT(toile_body_state, body_revision, 24);
AT(toile_body_state, joints, 32);
AT(toile_body_state, positions, 56);
AT(toile_body_state, normals, 80);

SIZE(toile_body_source_info, 16);
AT(toile_body_source_info, size, 0);
AT(toile_body_source_info, input, 4);
AT(toile_body_source_info, schemes, 8);

SIZE(toile_body_source_setup, 40);
AT(toile_body_source_setup, size, 0);
AT(toile_body_source_setup, stream_count, 4);
AT(toile_body_source_setup, uri, 8);
AT(toile_body_source_setup, streams, 16);
AT(toile_body_source_setup, body, 24);
AT(toile_body_source_setup, max_people, 32);
AT(toile_body_source_setup, reserved, 36);

SIZE(toile_body_source_input, 24);
AT(toile_body_source_input, size, 0);
AT(toile_body_source_input, frame_count, 4);
AT(toile_body_source_input, frames, 8);
AT(toile_body_source_input, scan, 16);

SIZE(toile_person, 144);
AT(toile_person, size, 0);
AT(toile_person, has_new_body, 4);
AT(toile_person, body, 8);
AT(toile_person, state, 16);
AT(toile_person, joints, 120);

SIZE(toile_body_source, 48);
AT(toile_body_source, size, 0);
AT(toile_body_source, reserved, 4);
AT(toile_body_source, describe, 8);
AT(toile_body_source, begin, 16);
AT(toile_body_source, feed, 24);
AT(toile_body_source, result, 32);
AT(toile_body_source, end, 40);

SIZE(toile_seam, 8);
AT(toile_seam, a, 0);
AT(toile_seam, b, 4);

SIZE(toile_cloth_garment, 288);
AT(toile_cloth_garment, size, 0);
AT(toile_cloth_garment, layer, 4);
AT(toile_cloth_garment, rest, 8);
AT(toile_cloth_garment, joint_indices, 144);
AT(toile_cloth_garment, joint_weights, 168);
AT(toile_cloth_garment, attachment, 192);
AT(toile_cloth_garment, seams, 216);
AT(toile_cloth_garment, fabric, 240);

SIZE(toile_garment_target, 32);
AT(toile_garment_target, garment, 0);
AT(toile_garment_target, reserved, 4);
AT(toile_garment_target, positions, 8);

SIZE(toile_garment_state, 56);
AT(toile_garment_state, size, 0);
AT(toile_garment_state, garment, 4);
AT(toile_garment_state, positions, 8);
AT(toile_garment_state, normals, 32);

SIZE(toile_cloth_step, 56);
AT(toile_cloth_step, size, 0);
AT(toile_cloth_step, flags, 4);
AT(toile_cloth_step, body_before, 8);
AT(toile_cloth_step, body_after, 16);
AT(toile_cloth_step, dt_s, 24);
AT(toile_cloth_step, targets, 32);
AT(toile_cloth_step, states, 40);
AT(toile_cloth_step, garment_count, 48);
AT(toile_cloth_step, reserved, 52);

SIZE(toile_cloth, 40);
AT(toile_cloth, size, 0);
AT(toile_cloth, reserved, 4);
AT(toile_cloth, set_body, 8);
AT(toile_cloth, add_garment, 16);
AT(toile_cloth, remove_garment, 24);
AT(toile_cloth, step, 32);

SIZE(toile_intrinsics, 104);
AT(toile_intrinsics, width, 0);
AT(toile_intrinsics, height, 4);
AT(toile_intrinsics, fx, 8);
AT(toile_intrinsics, fy, 16);
AT(toile_intrinsics, cx, 24);
AT(toile_intrinsics, cy, 32);
AT(toile_intrinsics, distortion, 40);

SIZE(toile_stream, 488);
AT(toile_stream, size, 0);
AT(toile_stream, camera, 4);
AT(toile_stream, depth, 8);
AT(toile_stream, color, 112);
AT(toile_stream, color_from_depth, 216);
AT(toile_stream, world_from_camera, 344);
AT(toile_stream, has_world, 472);
AT(toile_stream, registered, 476);
AT(toile_stream, frame_period_s, 480);

SIZE(toile_frame, 72);
AT(toile_frame, size, 0);
AT(toile_frame, camera, 4);
AT(toile_frame, sequence, 8);
AT(toile_frame, reserved, 12);
AT(toile_frame, timestamp_ns, 16);
AT(toile_frame, depth_m, 24);
AT(toile_frame, color, 48);

SIZE(toile_fabric, 44);
AT(toile_fabric, size, 0);
AT(toile_fabric, reserved, 4);
AT(toile_fabric, density_kg_m2, 8);
AT(toile_fabric, thickness_m, 12);
AT(toile_fabric, stretch_warp_n_m, 16);
AT(toile_fabric, stretch_weft_n_m, 20);
AT(toile_fabric, shear_n_m, 24);
AT(toile_fabric, bend_warp_nm, 28);
AT(toile_fabric, bend_weft_nm, 32);
AT(toile_fabric, friction, 36);
AT(toile_fabric, damping, 40);

SIZE(toile_garment_package, 304);
AT(toile_garment_package, size, 0);
AT(toile_garment_package, layer, 4);
AT(toile_garment_package, id, 8);
AT(toile_garment_package, version, 16);
AT(toile_garment_package, size_name, 24);
AT(toile_garment_package, simulation, 32);
AT(toile_garment_package, joint_indices, 168);
AT(toile_garment_package, joint_weights, 192);
AT(toile_garment_package, pins, 216);
AT(toile_garment_package, made_on, 240);
AT(toile_garment_package, fabric, 248);
AT(toile_garment_package, ease_m, 292);
AT(toile_garment_package, reserved, 296);

SIZE(toile_garment_binding, 104);
AT(toile_garment_binding, size, 0);
AT(toile_garment_binding, reserved, 4);
AT(toile_garment_binding, positions, 8);
AT(toile_garment_binding, joint_indices, 32);
AT(toile_garment_binding, joint_weights, 56);
AT(toile_garment_binding, attachment, 80);

SIZE(toile_garment, 24);
AT(toile_garment, size, 0);
AT(toile_garment, reserved, 4);
AT(toile_garment, bind, 8);
AT(toile_garment, targets, 16);

SIZE(toile_host, 40);
AT(toile_host, size, 0);
AT(toile_host, abi_minor, 4);
AT(toile_host, host_data, 8);
AT(toile_host, host_version, 16);
AT(toile_host, get_extension, 24);
AT(toile_host, report, 32);

SIZE(toile_thread_pool, 24);
AT(toile_thread_pool, size, 0);
AT(toile_thread_pool, reserved, 4);
AT(toile_thread_pool, thread_count, 8);
AT(toile_thread_pool, parallel_for, 16);

SIZE(toile_parameter, 56);
AT(toile_parameter, size, 0);
AT(toile_parameter, type, 4);
AT(toile_parameter, id, 8);
AT(toile_parameter, unit, 16);
AT(toile_parameter, text, 24);
AT(toile_parameter, minimum, 32);
AT(toile_parameter, maximum, 40);
AT(toile_parameter, default_value, 48);

SIZE(toile_parameters, 40);
AT(toile_parameters, size, 0);
AT(toile_parameters, reserved, 4);
AT(toile_parameters, count, 8);
AT(toile_parameters, describe, 16);
AT(toile_parameters, get, 24);
AT(toile_parameters, set, 32);

SIZE(toile_state, 24);
AT(toile_state, size, 0);
AT(toile_state, reserved, 4);
AT(toile_state, save, 8);
AT(toile_state, load, 16);

SIZE(toile_debug_line, 28);
AT(toile_debug_line, from, 0);
AT(toile_debug_line, to, 12);
AT(toile_debug_line, rgba, 24);

SIZE(toile_debug_draw, 16);
AT(toile_debug_draw, size, 0);
AT(toile_debug_draw, reserved, 4);
AT(toile_debug_draw, lines, 8);

SIZE(toile_descriptor, 48);
AT(toile_descriptor, size, 0);
AT(toile_descriptor, reserved, 4);
AT(toile_descriptor, id, 8);
AT(toile_descriptor, name, 16);
AT(toile_descriptor, version, 24);
AT(toile_descriptor, vendor, 32);
AT(toile_descriptor, kinds, 40);

SIZE(toile_limits, 40);
AT(toile_limits, size, 0);
AT(toile_limits, max_people, 4);
AT(toile_limits, max_vertices, 8);
AT(toile_limits, max_triangles, 12);
AT(toile_limits, thread_count, 16);
AT(toile_limits, live_clock, 20);
AT(toile_limits, frame_budget_s, 24);
AT(toile_limits, random_seed, 32);

SIZE(toile_instance, 72);
AT(toile_instance, size, 0);
AT(toile_instance, reserved, 4);
AT(toile_instance, descriptor, 8);
AT(toile_instance, plugin_data, 16);
AT(toile_instance, init, 24);
AT(toile_instance, activate, 32);
AT(toile_instance, deactivate, 40);
AT(toile_instance, reset, 48);
AT(toile_instance, destroy, 56);
AT(toile_instance, get_extension, 64);

SIZE(toile_entry, 56);
AT(toile_entry, size, 0);
AT(toile_entry, abi_major, 4);
AT(toile_entry, abi_minor, 8);
AT(toile_entry, reserved, 12);
AT(toile_entry, init, 16);
AT(toile_entry, deinit, 24);
AT(toile_entry, count, 32);
AT(toile_entry, describe, 40);
AT(toile_entry, create, 48);

SIZE(toile_resize_request, 88);
AT(toile_resize_request, size, 0);
AT(toile_resize_request, strips, 4);
AT(toile_resize_request, subject, 8);
AT(toile_resize_request, target, 16);
AT(toile_resize_request, region, 24);
AT(toile_resize_request, target_region, 48);
AT(toile_resize_request, body_before, 72);
AT(toile_resize_request, body_after, 80);

SIZE(toile_resizer, 16);
AT(toile_resizer, size, 0);
AT(toile_resizer, reserved, 4);
AT(toile_resizer, resize, 8);

SIZE(toile_scan_sink, 48);
AT(toile_scan_sink, size, 0);
AT(toile_scan_sink, reserved, 4);
AT(toile_scan_sink, mesh, 8);
AT(toile_scan_sink, sink_data, 16);
AT(toile_scan_sink, texture, 24);
AT(toile_scan_sink, skin, 32);
AT(toile_scan_sink, report, 40);

SIZE(toile_scanner, 32);
AT(toile_scanner, size, 0);
AT(toile_scanner, reserved, 4);
AT(toile_scanner, begin, 8);
AT(toile_scanner, feed, 16);
AT(toile_scanner, finish, 24);

SIZE(toile_sensor, 48);
AT(toile_sensor, size, 0);
AT(toile_sensor, reserved, 4);
AT(toile_sensor, open, 8);
AT(toile_sensor, stream_count, 16);
AT(toile_sensor, describe, 24);
AT(toile_sensor, poll, 32);
AT(toile_sensor, release, 40);

SIZE(toile_true_camera, 152);
AT(toile_true_camera, size, 0);
AT(toile_true_camera, reserved, 4);
AT(toile_true_camera, world_from_camera, 8);
AT(toile_true_camera, depth_scale, 136);
AT(toile_true_camera, name, 144);

SIZE(toile_true_surface, 24);
AT(toile_true_surface, size, 0);
AT(toile_true_surface, role, 4);
AT(toile_true_surface, person_id, 8);
AT(toile_true_surface, reserved, 12);
AT(toile_true_surface, name, 16);

SIZE(toile_truth, 40);
AT(toile_truth, size, 0);
AT(toile_truth, reserved, 4);
AT(toile_truth, people, 8);
AT(toile_truth, camera, 16);
AT(toile_truth, surface_count, 24);
AT(toile_truth, surface, 32);

SIZE(toile_skinning, 24);
AT(toile_skinning, size, 0);
AT(toile_skinning, reserved, 4);
AT(toile_skinning, bind, 8);
AT(toile_skinning, pose, 16);

SIZE(toile_tool_option, 64);
AT(toile_tool_option, size, 0);
AT(toile_tool_option, type, 4);
AT(toile_tool_option, flags, 8);
AT(toile_tool_option, reserved, 12);
AT(toile_tool_option, name, 16);
AT(toile_tool_option, value_name, 24);
AT(toile_tool_option, text, 32);
AT(toile_tool_option, default_value, 40);
AT(toile_tool_option, minimum, 48);
AT(toile_tool_option, maximum, 56);

SIZE(toile_tool_info, 40);
AT(toile_tool_info, size, 0);
AT(toile_tool_info, option_count, 4);
AT(toile_tool_info, command, 8);
AT(toile_tool_info, summary, 16);
AT(toile_tool_info, example, 24);
AT(toile_tool_info, options, 32);

SIZE(toile_tool, 24);
AT(toile_tool, size, 0);
AT(toile_tool, reserved, 4);
AT(toile_tool, describe, 8);
AT(toile_tool, run, 16);

SIZE(toile_body_fit_options, 16);
AT(toile_body_fit_options, size, 0);
AT(toile_body_fit_options, sex, 4);
AT(toile_body_fit_options, dressed, 8);
AT(toile_body_fit_options, reserved, 12);

SIZE(toile_body_fit, 32);
AT(toile_body_fit, size, 0);
AT(toile_body_fit, reserved, 4);
AT(toile_body_fit, fit, 8);
AT(toile_body_fit, surface, 16);
AT(toile_body_fit, report, 24);

SIZE(toile_scan_template, 168);
AT(toile_scan_template, size, 0);
AT(toile_scan_template, instant, 4);
AT(toile_scan_template, surface, 8);
AT(toile_scan_template, part_labels, 144);

SIZE(toile_part_picture, 56);
AT(toile_part_picture, size, 0);
AT(toile_part_picture, reserved, 4);
AT(toile_part_picture, parts, 8);
AT(toile_part_picture, people, 32);

SIZE(toile_part_labels, 16);
AT(toile_part_labels, size, 0);
AT(toile_part_labels, reserved, 4);
AT(toile_part_labels, labels, 8);

SIZE(toile_scan_guide, 16);
AT(toile_scan_guide, size, 0);
AT(toile_scan_guide, reserved, 4);
AT(toile_scan_guide, guide, 8);
