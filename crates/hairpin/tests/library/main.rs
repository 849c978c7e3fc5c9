//! What the library promises, from the outside: each claim checked by equations, integrators or counts of the tests'
//! own.

mod campaign;
mod campaigns;
mod carried_states;
mod certificates;
mod controls;
mod crab_drives;
mod drive_environments;
mod figure_4;
mod flight_software;
mod going_around;
mod ground_drives;
mod ground_roadmap;
mod heaviest_proofs;
mod heaviest_walks;
mod kinematics;
mod own_controllers;
mod physics;
mod reach;
mod reach_brute_force;
mod reach_hull;
mod same_bits;
mod steering;
mod step_responses;
mod stressed_controllers;
mod tampered_witness;
