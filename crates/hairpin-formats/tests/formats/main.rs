//! What goes in and out of files: read back by what wrote it and by equations of the tests' own, spoiled, cut and
//! killed.
//! What silences panics is a program of its own (`fuzz`, `out_broken`), for a hook is the whole process's, and so is
//! what starts and kills itself (`out_atomic`).

mod mars_yard;
mod ned;
mod out_agreement;
mod out_campaign;
mod out_folder;
mod out_report;
mod out_texts;
mod rasters;
mod readers;
mod scenario_mistakes;
mod scenario_round_trip;
mod scenario_shipped;
