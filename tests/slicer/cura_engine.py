"""Cura's engine, driven without Cura: settings in, G-code out.

Debian's cura-engine comes without the definitions that Cura hands it.  ``_DEFAULTS`` is all that
version 4.13 asks for, with the default values of Cura's fdmprinter.def.json, by value.
"""

from __future__ import annotations

import subprocess
from collections.abc import Mapping
from pathlib import Path

from printprep.profiles import Profile

_DEFAULTS = {
    "false": (
        "acceleration_enabled adaptive_layer_height_enabled alternate_extra_perimeter "
        "anti_overhang_mesh bridge_settings_enabled center_object clean_between_layers "
        "coasting_enable conical_overhang_enabled connect_skin_polygons cool_lift_head "
        "cutting_mesh draft_shield_enabled fill_outline_gaps infill_enable_travel_optimization "
        "infill_mesh infill_randomize_start_location infill_support_enabled ironing_enabled "
        "ironing_only_highest_layer jerk_enabled machine_always_write_active_tool "
        "machine_center_is_zero machine_extruders_share_heater machine_extruders_share_nozzle "
        "machine_firmware_retract machine_heated_bed machine_heated_build_volume "
        "magic_fuzzy_skin_enabled magic_spiralize material_flow_dependent_temperature "
        "meshfix_extensive_stitching meshfix_keep_open_polygons meshfix_union_all_remove_holes "
        "mold_enabled ooze_shield_enabled optimize_wall_printing_order outer_inset_first "
        "prime_blob_enable prime_tower_enable relative_extrusion retract_at_layer_change "
        "retraction_hop_enabled retraction_hop_only_when_collides roofing_monotonic "
        "skin_monotonic skin_no_small_gaps_heuristic speed_equalize_flow_enabled "
        "support_bottom_enable support_brim_enable support_conical_enabled support_enable "
        "support_fan_enable support_mesh support_roof_enable support_skip_some_zags "
        "travel_avoid_supports travel_retract_before_outer_wall wall_min_flow_retract "
        "wireframe_enabled z_seam_relative zig_zaggify_infill zig_zaggify_support"
    ),
    "0": (
        "adhesion_extruder_nr bridge_fan_speed_2 bridge_fan_speed_3 "
        "bridge_sparse_infill_max_density brim_gap cool_fan_speed_0 "
        "flow_rate_max_extrusion_offset gradual_infill_steps gradual_support_infill_steps "
        "hole_xy_offset infill_mesh_order infill_offset_x infill_offset_y infill_wall_line_count "
        "layer_start_x layer_start_y machine_extruder_cooling_fan_number machine_minimum_feedrate "
        "machine_nozzle_offset_x machine_nozzle_offset_y mesh_position_x mesh_position_y "
        "mesh_position_z min_infill_area min_skin_width_for_expansion minimum_support_area "
        "retraction_combing_max_distance retraction_extra_prime_amount roofing_layer_count "
        "small_feature_max_length support_bottom_extruder_nr support_extruder_nr_layer_0 "
        "support_infill_extruder_nr support_offset support_roof_extruder_nr wall_0_inset "
        "wall_min_flow wipe_pause wipe_retraction_extra_prime_amount xy_offset xy_offset_layer_0"
    ),
    "100": (
        "bridge_fan_speed bridge_skin_density bridge_skin_material_flow_2 bridge_wall_coast "
        "cool_fan_speed_max cool_fan_speed_min flow_rate_extrusion_offset_factor "
        "infill_material_flow machine_max_acceleration_z material_flow_layer_0 "
        "material_shrinkage_percentage prime_tower_flow roofing_material_flow skin_material_flow "
        "skirt_brim_material_flow support_bottom_material_flow support_material_flow "
        "support_roof_material_flow wall_0_material_flow wall_overhang_speed_factor "
        "wall_x_material_flow wipe_brush_pos_x z_seam_x z_seam_y"
    ),
    "20": (
        "brim_line_count jerk_infill jerk_ironing jerk_prime_tower jerk_print_layer_0 "
        "jerk_roofing jerk_skirt_brim jerk_support_bottom jerk_support_infill jerk_support_roof "
        "jerk_topbottom jerk_travel_layer_0 jerk_wall_0 jerk_wall_x machine_max_jerk_xy "
        "raft_base_jerk raft_interface_jerk raft_surface_jerk raft_surface_speed speed_ironing "
        "switch_extruder_prime_speed switch_extruder_retraction_amount "
        "switch_extruder_retraction_speed wipe_move_distance"
    ),
    "true": (
        "alternate_carve_order brim_outside_only carve_multiple_volumes connect_infill_polygons "
        "cool_fan_enabled filter_out_tiny_gaps infill_before_walls limit_support_retractions "
        "machine_nozzle_temp_enabled machine_use_extruder_offset_to_offset_coords "
        "material_bed_temp_prepend material_print_temp_prepend material_print_temp_wait "
        "meshfix_union_all remove_empty_first_layers retraction_enable support_connect_zigzags "
        "support_use_towers travel_avoid_other_parts "
        "travel_compensate_overlapping_walls_0_enabled "
        "travel_compensate_overlapping_walls_x_enabled wipe_hop_enable wipe_retraction_enable"
    ),
    "3000": (
        "acceleration_infill acceleration_ironing acceleration_prime_tower "
        "acceleration_print_layer_0 acceleration_roofing acceleration_skirt_brim "
        "acceleration_support_bottom acceleration_support_infill acceleration_support_roof "
        "acceleration_topbottom acceleration_travel_layer_0 acceleration_wall_0 "
        "acceleration_wall_x raft_base_acceleration raft_interface_acceleration "
        "raft_surface_acceleration"
    ),
    "1": (
        "bottom_skin_expand_distance bottom_skin_preshrink gradual_support_infill_step_height "
        "infill_multiplier machine_nozzle_tip_outer_diameter meshfix_maximum_travel_resolution "
        "minimum_polygon_circumference retraction_hop retraction_hop_after_extruder_switch_height "
        "skin_outline_count support_wall_count top_skin_expand_distance top_skin_preshrink "
        "wipe_hop_amount wipe_retraction_amount"
    ),
    "10": (
        "cool_min_layer_time_fan_speed_max cool_min_speed ironing_flow max_extrusion_before_wipe "
        "speed_z_hop support_bottom_stair_step_min_slope wipe_hop_speed"
    ),
    "2": (
        "cool_fan_full_layer cross_infill_pocket_size machine_nozzle_cool_down_speed "
        "speed_slowdown_layers support_join_distance wall_line_count wipe_retraction_prime_speed"
    ),
    "60": (
        "bridge_skin_material_flow material_bed_temperature_layer_0 speed_infill "
        "speed_prime_tower speed_support_infill speed_travel_layer_0 speed_wall_x"
    ),
    "30": (
        "jerk_travel skirt_brim_speed speed_print_layer_0 speed_topbottom speed_wall_0 "
        "support_conical_angle"
    ),
    "5": (
        "bridge_wall_min_length cool_min_layer_time machine_max_jerk_e "
        "support_bottom_stair_step_width support_zag_skip_count wipe_repeat_count"
    ),
    "[ ]": (
        "infill_angles roofing_angles skin_angles support_bottom_angles support_infill_angles "
        "support_roof_angles"
    ),
    "-1": (
        "infill_extruder_nr roofing_extruder_nr top_bottom_extruder_nr wall_0_extruder_nr "
        "wall_x_extruder_nr"
    ),
    "15": (
        "bridge_skin_speed bridge_skin_speed_3 bridge_wall_speed raft_base_speed "
        "raft_interface_speed"
    ),
    "25": "bridge_skin_speed_2 retraction_prime_speed retraction_retract_speed speed_roofing",
    "299792458000": (
        "machine_max_feedrate_e machine_max_feedrate_x machine_max_feedrate_y "
        "machine_max_feedrate_z"
    ),
    "50": (
        "bridge_wall_material_flow small_feature_speed_factor small_feature_speed_factor_0 "
        "support_angle"
    ),
    "0.1": "raft_surface_thickness support_bottom_distance support_top_distance",
    "0.4": "machine_max_jerk_z machine_nozzle_size support_tree_collision_resolution",
    "3": (
        "support_tower_diameter support_tower_maximum_supported_diameter "
        "wipe_retraction_retract_speed"
    ),
    "40": "speed_support_bottom speed_support_roof support_tree_angle",
    "lines": "roofing_pattern top_bottom_pattern top_bottom_pattern_0",
    "": "machine_extruder_start_code material_guid",
    "0.2": "support_xy_distance_overhang wall_0_wipe_dist",
    "0.3": "raft_base_thickness support_bottom_stair_step_height",
    "0.7": "material_extrusion_cool_down_speed support_xy_distance",
    "1.5": "gradual_infill_step_height retraction_min_travel",
    "90": "retraction_count_max wall_overhang_angle",
    "9000": "machine_max_acceleration_x machine_max_acceleration_y",
    "concentric": "support_bottom_pattern support_roof_pattern",
    "normal": "magic_mesh_surface_mode support_structure",
    "0.025": "meshfix_maximum_deviation",
    "0.04": "infill_wipe_dist",
    "0.15": "raft_interface_thickness",
    "0.5": "meshfix_maximum_resolution",
    "0.625": "travel_avoid_distance",
    "10000": "machine_max_acceleration_e",
    "110": "bridge_skin_material_flow_3",
    "120": "speed_travel",
    "2.66": "support_line_distance",
    "200": "material_initial_print_temperature",
    "210": "material_print_temperature",
    "215": "material_print_temperature_layer_0",
    "250": "skirt_brim_minimal_length",
    "4": "skin_edge_support_layers",
    "4.5": "retraction_extrusion_window",
    "4000": "machine_acceleration",
    "5000": "acceleration_travel",
    "6.5": "retraction_amount",
    "65": "support_tower_roof_angle",
    "RepRap (Marlin/Sprinter)": "machine_gcode_flavor",
    "Unknown": "machine_name",
    "[[1,0,0], [0,1,0], [0,0,1]]": "mesh_rotation_matrix",
    "[[3.5,200],[7.0,240]]": "material_flow_temp_graph",
    "all": "retraction_combing",
    "everywhere": "fill_perimeter_gaps",
    "glass": "machine_buildplate_type",
    "middle": "slicing_tolerance",
    "rectangular": "machine_shape",
    "sharpest_corner": "z_seam_type",
    "z_overrides_xy": "support_xy_overrides_z",
    "z_seam_corner_inner": "z_seam_corner",
    "zigzag": "support_pattern",
}
_WIDTHS = (
    "infill_line_width prime_tower_line_width raft_base_line_width raft_interface_line_width "
    "raft_surface_line_width roofing_line_width skin_line_width skirt_brim_line_width "
    "support_bottom_line_width support_line_width support_roof_line_width wall_line_width_0 "
    "wall_line_width_x"
)
_WHOLE = "999999"  # layers of skin: what Cura's formulas make of an infill of 100 %


def as_set_by_hand(profile: Profile) -> dict[str, str]:
    """The settings that ``hollow --for cura`` asks for, with what Cura derives from them."""
    printer = profile.printer
    layer, width = f"{printer.layer_height_mm:g}", f"{printer.line_width_mm:g}"
    x, y, z = (f"{side:g}" for side in printer.bed_mm)
    settings = {key: value for value, keys in _DEFAULTS.items() for key in keys.split()}
    settings |= dict.fromkeys(_WIDTHS.split(), width)
    return settings | {
        "layer_height": layer,
        "infill_sparse_thickness": layer,
        "support_infill_sparse_thickness": layer,
        "layer_height_0": f"{printer.first_layer_mm:g}",
        "machine_width": x,
        "machine_depth": y,
        "machine_height": z,
        "initial_layer_line_width_factor": "100",
        "material_diameter": "1.75",
        "infill_pattern": "lines",
        "infill_line_distance": width,
        "infill_overlap_mm": f"{0.1 * printer.line_width_mm:g}",
        "skin_overlap_mm": f"{0.05 * printer.line_width_mm:g}",
        "top_layers": _WHOLE,
        "bottom_layers": _WHOLE,
        "initial_bottom_layers": _WHOLE,
        "support_type": "buildplate",
        "adhesion_type": "none",
        "machine_start_gcode": "",
        "machine_end_gcode": "",
    }


def slice_with_cura(engine: Path, model: Path, out: Path, settings: Mapping[str, str]) -> None:
    """Slice an STL in the middle of the bed."""
    words = [word for key, value in settings.items() for word in ("-s", f"{key}={value}")]
    command = [str(engine), "slice", "-o", str(out), *words, "-e0", *words, "-l", str(model)]
    done = subprocess.run(command, capture_output=True, encoding="utf-8", check=False, timeout=120)
    assert done.returncode == 0, done.stderr[-2000:]
    assert "no value given" not in done.stderr, done.stderr[-2000:]
