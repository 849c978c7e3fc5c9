//! The doors of hairpin: scenario and robot files in; Parquet, JUnit, TUM, CSV and HTML out.

pub mod atomic;
pub mod csv;
pub mod executor;
pub mod folder;
pub mod junit;
pub mod parquet;
pub mod report;
pub mod tum;
pub mod waypoints;
