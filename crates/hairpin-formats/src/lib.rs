//! The doors of hairpin: scenario and robot files in; Parquet, JUnit, TUM, CSV and HTML out.

#![cfg_attr(not(test), deny(clippy::unwrap_used))] // tests may, what meets users' data may not

pub mod arcs;
pub mod atomic;
pub mod banner;
pub mod bounds;
mod channels;
pub mod checksum;
pub mod cloud;
pub mod controller_log;
mod controllers;
pub mod costs;
pub mod csv;
pub mod decimal;
mod delimited;
pub mod epsg;
pub mod executor;
pub mod figure;
pub mod folder;
pub mod foreign;
pub mod frames;
pub mod geodetic;
pub mod header;
pub mod joint_trajectory;
pub mod junit;
pub mod krl;
pub mod library;
pub mod listing;
mod lockstep;
pub mod mesh;
pub mod parquet;
pub mod placement;
pub mod quote;
pub mod rapid;
pub mod recordings;
pub mod report;
pub mod repro;
pub mod rotor_speeds;
pub mod scenario;
pub mod schema;
pub mod steering;
pub mod template;
pub mod terrain;
pub mod tum;
pub mod urdf;
pub mod urscript;
pub mod waypoints;
