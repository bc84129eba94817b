//! Every experiment that ships runs, and keeps what its `expected.toml` claims.

use pseudopod::analysis::claims::ClaimResult;
use pseudopod::run::{Quiet, RunOptions};
use pseudopod::verify::{subjects, table};
use std::path::Path;

/// Runs a document and checks the claims beside it; prints each with what was found.
fn experiment_keeps_its_word(folder: &str, document: &str) {
    let experiments = Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments");
    let experiment = experiments.join(folder).join(document);
    let subject = subjects(&experiment, None).unwrap().remove(0);
    let scratch = tempfile::tempdir().unwrap();
    let result = scratch.path().join("result.h5");
    let results = subject.verify(&RunOptions::new(&result), &mut Quiet).unwrap();
    println!("{}", table(&results));
    assert!(results.iter().all(ClaimResult::holds), "a claim does not hold; see above");
    let made = pseudopod::picture::make_defaults(&result).unwrap();
    assert!(made.iter().all(|path| path.metadata().is_ok_and(|file| file.len() > 1000)), "{made:?}");
    for (_, made, shown) in SHOWN.iter().filter(|(about, ..)| experiments.join(about) == experiment) {
        let shown = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/pictures").join(shown);
        let apart = mean_difference(&scratch.path().join(made), &shown);
        assert!(apart < 0.5, "{} is not what the command makes: levels {apart:.2} apart", shown.display());
    }
}

/// Pictures that a README shows as what a command makes: the document, the file beside its result, the picture in docs/pictures.
const SHOWN: [(&str, &str, &str); 46] = [
    ("aggregation/experiment.toml", "result.png", "aggregation.png"),
    ("aspiration/experiment.toml", "result.png", "aspiration.png"),
    ("aspiration/release.toml", "result.recovery.png", "aspiration_release.png"),
    ("bending_volume/linear.toml", "result.png", "bending_volume.png"),
    ("cAMP_waves/experiment.toml", "result.png", "camp_waves.png"),
    ("cantilever/experiment.toml", "result.deflection.png", "cantilever.png"),
    ("chemotaxis/experiment.toml", "result.png", "chemotaxis.png"),
    ("chemotaxis/experiment.toml", "result.tracks.png", "chemotaxis_tracks.png"),
    ("chemotaxis_field/experiment.toml", "result.png", "chemotaxis_field.png"),
    ("contact_inhibition/experiment.toml", "result.png", "contact_inhibition.png"),
    ("contact_inhibition/experiment.toml", "result.touched.png", "contact_inhibition_touched.png"),
    ("cylinder/experiment.toml", "result.force.png", "cylinder.png"),
    ("dictyostelium/mound.toml", "result.png", "dictyostelium_mound.png"),
    ("doublet/experiment.toml", "result.png", "doublet.png"),
    ("doublet/experiment.toml", "result.area.png", "doublet_area.png"),
    ("falling_spheres/experiment.toml", "result.png", "falling_spheres.png"),
    ("four_bunnies/experiment.toml", "result.png", "four_bunnies.png"),
    ("haptotaxis/experiment.toml", "result.png", "haptotaxis.png"),
    ("haptotaxis/experiment.toml", "result.tracks.png", "haptotaxis_tracks.png"),
    ("links_36/experiment.toml", "result.png", "links_36.png"),
    ("microplates/experiment.toml", "result.elongation.png", "microplates.png"),
    ("motility/fibres.toml", "result.png", "motility_fibres.png"),
    ("optical_stretcher/experiment.toml", "result.length.png", "optical_stretcher.png"),
    ("optical_tweezers/red_cell.toml", "result.png", "red_cell.png"),
    ("optical_tweezers/red_cell.toml", "result.force_diameter.png", "force_diameter.png"),
    ("persistent_migration/experiment.toml", "result.persistence.png", "persistent_migration.png"),
    ("plate/experiment.toml", "result.png", "plate.png"),
    ("polarity/experiment.toml", "result.png", "polarity.png"),
    ("pseudopods/experiment.toml", "result.png", "pseudopods.png"),
    ("red_cell_recovery/experiment.toml", "result.recovery.png", "red_cell_recovery.png"),
    ("rolling_ball/experiment.toml", "result.png", "rolling_ball.png"),
    ("sorting/experiment.toml", "result.png", "sorting.png"),
    ("sorting/experiment.toml", "result.segregation.png", "sorting_segregation.png"),
    ("sorting/two_hundred.toml", "result.png", "sorting_two_hundred.png"),
    ("sphere_under_gravity/experiment.toml", "result.png", "spheres.png"),
    ("spreading/experiment.toml", "result.png", "spreading.png"),
    ("spreading/experiment.toml", "result.area.png", "spreading_area.png"),
    ("squeezed_drop/experiment.toml", "result.png", "squeezed_drop.png"),
    ("squeezed_drop/experiment.toml", "result.height_force.png", "squeezed_drop_force.png"),
    ("sticky_pair/experiment.toml", "result.png", "sticky_pair.png"),
    ("substrates/experiment.toml", "result.png", "substrates_sheet.png"),
    ("substrates/step.toml", "result.png", "substrates_step.png"),
    ("traction/experiment.toml", "result.png", "traction.png"),
    ("traction_gel/experiment.toml", "result.png", "traction_gel.png"),
    ("truth_cube/experiment.toml", "result.png", "truth_cube.png"),
    ("turing/experiment.toml", "result.png", "turing.png"),
];

/// How far the colours of two pictures of one size are apart, in levels of 255; round-off may move an edge by a pixel here and there.
pub(super) fn mean_difference(one: &Path, other: &Path) -> f64 {
    let pixels = |path: &Path| {
        let file = std::io::BufReader::new(std::fs::File::open(path).unwrap());
        let mut reader = png::Decoder::new(file).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut pixels).unwrap();
        (info.width, info.height, pixels)
    };
    let ((width, height, one), (other_width, other_height, other)) = (pixels(one), pixels(other));
    assert_eq!((width, height, one.len()), (other_width, other_height, other.len()));
    let sum: u64 = one.iter().zip(&other).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    sum as f64 / one.len() as f64
}

#[test]
fn a_red_cell_stretches_as_mills_measured() {
    experiment_keeps_its_word("optical_tweezers", "red_cell.toml");
}

#[test]
fn red_cells_recover_in_the_times_that_hochmuth_measured() {
    experiment_keeps_its_word("red_cell_recovery", "experiment.toml");
    experiment_keeps_its_word("red_cell_recovery", "cell2.toml");
}

#[test]
fn a_cell_is_drawn_into_a_pipette_as_its_tension_lets_it() {
    experiment_keeps_its_word("aspiration", "experiment.toml");
}

#[test]
fn a_cell_that_is_let_out_of_a_pipette_recovers_with_viscosity_over_tension() {
    experiment_keeps_its_word("aspiration", "release.toml");
}

#[test]
#[ignore = "slow: a minute and a half, a drop of 642 atoms that is finest at the mouth"]
fn the_suction_that_draws_a_cell_in_is_that_of_its_tension() {
    experiment_keeps_its_word("aspiration", "critical.toml");
}

#[test]
#[ignore = "slow: two minutes; cargo test --release --test figures an_elastic_body_is -- --ignored"]
fn an_elastic_body_is_drawn_into_a_pipette_as_a_half_space_is() {
    experiment_keeps_its_word("aspiration", "elastic.toml");
}

#[test]
fn microplates_read_what_was_put_in() {
    experiment_keeps_its_word("microplates", "experiment.toml");
    experiment_keeps_its_word("microplates", "uniform.toml");
}

#[test]
fn every_material_passes_the_patch_test() {
    experiment_keeps_its_word("patch_test", "experiment.toml");
}

#[test]
fn a_plate_bends_as_reissner_and_mindlin_say_but_for_its_mesh() {
    experiment_keeps_its_word("plate", "experiment.toml");
}

#[test]
fn a_shell_dents_as_reissner_found() {
    experiment_keeps_its_word("indentation", "shell.toml");
}

#[test]
#[ignore = "slow: a minute and a half; cargo test --release --test figures a_ball_on_a_gel -- --ignored"]
fn a_ball_on_a_gel_feels_a_thin_layer() {
    experiment_keeps_its_word("indentation", "experiment.toml");
}

#[test]
#[ignore = "slow: two minutes; cargo test --release --test figures a_gel_that -- --ignored"]
fn a_gel_that_a_cell_pulls_at_moves_as_a_half_space() {
    experiment_keeps_its_word("traction_gel", "experiment.toml");
}

#[test]
#[ignore = "slow: half an hour; cargo test --release --test figures a_finer_gel -- --ignored"]
fn a_finer_gel_moves_more_as_a_half_space() {
    experiment_keeps_its_word("traction_gel", "fine.toml");
}

#[test]
fn a_cell_in_an_optical_stretcher_creeps_as_was_measured() {
    experiment_keeps_its_word("optical_stretcher", "experiment.toml");
}

#[test]
fn a_red_cell_with_the_modulus_that_was_fitted_stretches_as_mills_measured() {
    experiment_keeps_its_word("red_cell_fit", "experiment.toml");
}

#[test]
fn a_spherical_membrane_stretches_as_henon_derived() {
    experiment_keeps_its_word("optical_tweezers", "sphere.toml");
}

#[test]
fn shape_memory_stretches_like_a_membrane_after_one_calibrated_number() {
    experiment_keeps_its_word("optical_tweezers", "shape_memory.toml");
}

#[test]
fn four_cells_crawl_up_an_attractant() {
    experiment_keeps_its_word("chemotaxis", "experiment.toml");
}

#[test]
fn receptors_tell_a_clear_gradient_from_a_faint_one_and_one_that_binds_them_all() {
    experiment_keeps_its_word("chemotactic_index", "experiment.toml");
}

#[test]
fn a_cell_crawls_by_pseudopods() {
    experiment_keeps_its_word("motility", "experiment.toml");
}

#[test]
fn a_cell_crawls_by_fibres_that_come_and_go() {
    experiment_keeps_its_word("motility", "fibres.toml");
}

#[test]
fn a_crawling_cell_draws_the_glass_together() {
    experiment_keeps_its_word("traction", "experiment.toml");
}

#[test]
fn pseudopods_arise_by_themselves_beside_each_other() {
    experiment_keeps_its_word("pseudopods", "experiment.toml");
}

#[test]
#[ignore = "slow: four cells, three to four minutes"]
fn pseudopods_go_left_and_right_in_turns() {
    experiment_keeps_its_word("pseudopods", "statistics.toml");
}

#[test]
fn three_cells_follow_the_trace_of_one() {
    experiment_keeps_its_word("haptotaxis", "experiment.toml");
}

#[test]
#[ignore = "slow: half a minute each; the control and the larger group of the test above"]
fn without_a_trace_none_follows_and_five_follow_as_three_do() {
    experiment_keeps_its_word("haptotaxis", "control.toml");
    experiment_keeps_its_word("haptotaxis", "six.toml");
}

#[test]
#[ignore = "slow: half a minute"]
fn the_steeper_the_trace_the_faster_cells_drift() {
    experiment_keeps_its_word("haptotaxis", "slopes.toml");
}

#[test]
fn two_thousand_cells_wander_as_furth_says() {
    experiment_keeps_its_word("random_walk", "experiment.toml");
}

#[test]
fn linked_types_clump_in_one_aggregate_where_they_are_drawn_together() {
    experiment_keeps_its_word("links_36", "experiment.toml");
}

#[test]
fn linked_cells_that_are_hardly_drawn_together_make_small_aggregates() {
    experiment_keeps_its_word("links_36", "weak.toml");
}

#[test]
fn links_stiffen_a_compressed_cell() {
    experiment_keeps_its_word("compression", "experiment.toml");
}

#[test]
fn softer_spheres_lie_flatter() {
    experiment_keeps_its_word("sphere_under_gravity", "experiment.toml");
}

#[test]
fn shape_memory_bears_a_step_that_springs_do_not() {
    experiment_keeps_its_word("stability_limits", "experiment.toml");
}

#[test]
fn three_times_what_decays_moves_an_atom() {
    experiment_keeps_its_word("decay_transfer", "experiment.toml");
}

#[test]
fn four_cells_climb_the_attractant_they_sense() {
    experiment_keeps_its_word("chemotaxis_field", "experiment.toml");
}

#[test]
fn cells_relay_waves_of_camp() {
    experiment_keeps_its_word("cAMP_waves", "experiment.toml");
}

#[test]
fn a_brusselator_takes_its_wavelength() {
    experiment_keeps_its_word("turing", "experiment.toml");
}

#[test]
fn a_cell_finds_a_front_and_turns_it() {
    experiment_keeps_its_word("polarity", "experiment.toml");
}

#[test]
fn twenty_five_cells_become_one_aggregate() {
    experiment_keeps_its_word("aggregation", "experiment.toml");
}

#[test]
#[ignore = "slow: a minute and a half"]
fn no_facet_folds_in_a_packed_aggregate_stirred_for_1000_s() {
    experiment_keeps_its_word("aggregation", "stirred.toml");
}

#[test]
fn a_strong_pair_holds_where_a_weak_one_parts() {
    experiment_keeps_its_word("sticky_pair", "experiment.toml");
}

#[test]
fn six_spheres_come_to_rest_in_the_dent_they_make() {
    experiment_keeps_its_word("falling_spheres", "experiment.toml");
}

#[test]
fn a_ball_rolls_down_a_sheet_where_shear_holds_it() {
    experiment_keeps_its_word("rolling_ball", "experiment.toml");
}

#[test]
fn a_ball_rolls_down_a_plane_as_fast_as_drag_allows() {
    experiment_keeps_its_word("rolling_ball", "plane.toml");
}

#[test]
fn a_squeezed_drop_takes_its_exact_shape() {
    experiment_keeps_its_word("squeezed_drop", "experiment.toml");
}

#[test]
fn a_beam_follows_the_elastica_as_far_as_its_mesh_lets_it() {
    experiment_keeps_its_word("cantilever", "experiment.toml");
}

#[test]
fn a_rod_of_rubber_has_its_exact_force_and_width() {
    experiment_keeps_its_word("cylinder", "experiment.toml");
}

#[test]
fn a_cube_of_rubber_bulges_as_one_of_a_finer_mesh() {
    experiment_keeps_its_word("truth_cube", "experiment.toml");
}

#[test]
fn materials_change_the_volume_of_a_bent_rod_in_the_order_of_the_documents() {
    for document in ["linear.toml", "experiment.toml", "penalty.toml", "neo_hookean.toml"] {
        experiment_keeps_its_word("bending_volume", document);
    }
}

#[test]
fn drops_spread_on_glass_to_the_angle_of_young_and_dupre() {
    experiment_keeps_its_word("spreading", "experiment.toml");
}

#[test]
#[ignore = "slow: some three minutes"]
fn the_more_cohesive_cells_come_to_be_inside() {
    experiment_keeps_its_word("sorting", "engulfment.toml");
}

#[test]
#[ignore = "slow: a minute"]
fn cells_whose_tension_fluctuates_stay_together_and_do_not_sort() {
    experiment_keeps_its_word("sorting", "tension.toml");
}

#[test]
#[ignore = "slow: some seven minutes"]
fn two_hundred_cells_sort() {
    experiment_keeps_its_word("sorting", "two_hundred.toml");
}

#[test]
#[ignore = "slow: two minutes together"]
fn cells_that_stick_to_the_other_type_mix_and_those_that_stick_to_their_own_part() {
    experiment_keeps_its_word("sorting", "mixture.toml");
    experiment_keeps_its_word("sorting", "apart.toml");
}

#[test]
fn strokes_that_use_up_their_stores_are_of_one_length_whatever_the_period() {
    experiment_keeps_its_word("motility", "periods.toml");
}

#[test]
#[ignore = "slow: a minute"]
fn cells_that_heed_each_other_keep_apart() {
    experiment_keeps_its_word("contact_inhibition", "experiment.toml");
}

#[test]
#[ignore = "slow: half a minute each"]
fn cells_crawl_on_sheets_over_others_and_up_a_step() {
    experiment_keeps_its_word("substrates", "experiment.toml");
    experiment_keeps_its_word("substrates", "cells.toml");
    experiment_keeps_its_word("substrates", "step.toml");
}

#[test]
fn a_cell_crawls_into_a_channel_and_gets_as_narrow() {
    experiment_keeps_its_word("substrates", "channel.toml");
}

#[test]
#[ignore = "slow: a minute"]
fn cells_that_stick_too_little_or_too_much_get_nowhere() {
    experiment_keeps_its_word("adhesion_speed", "experiment.toml");
}

#[test]
#[ignore = "slow: a minute"]
fn amoebae_gather_up_the_waves_that_they_relay() {
    experiment_keeps_its_word("dictyostelium", "experiment.toml");
}

#[test]
#[ignore = "slow: some four minutes"]
fn prestalk_cells_sort_in_a_mound() {
    experiment_keeps_its_word("dictyostelium", "mound.toml");
}

#[test]
#[ignore = "slow: a minute"]
fn faster_cells_go_straighter() {
    experiment_keeps_its_word("persistent_migration", "experiment.toml");
}

#[test]
#[ignore = "slow: a minute"]
fn drops_that_stick_meet_at_the_angle_of_young_and_dupre() {
    experiment_keeps_its_word("doublet", "experiment.toml");
}

#[test]
fn four_bunnies_fall_between_each_others_ears() {
    experiment_keeps_its_word("four_bunnies", "experiment.toml");
}

#[test]
fn two_types_of_cells_sort() {
    experiment_keeps_its_word("sorting", "experiment.toml");
}

#[test]
#[ignore = "slow: an hour of a thousand cells, five to ten minutes"]
fn a_thousand_cells_gather_for_an_hour() {
    experiment_keeps_its_word("crowd", "experiment.toml");
}
