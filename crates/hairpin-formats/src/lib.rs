//! The doors of hairpin: scenario and robot files in; Parquet, JUnit, TUM, CSV and HTML out.

pub mod atomic;
pub mod csv;
pub mod decimal;
pub mod executor;
pub mod folder;
pub mod frames;
pub mod geodetic;
pub mod header;
pub mod junit;
pub mod library;
pub mod mesh;
pub mod parquet;
pub mod rapid;
pub mod report;
pub mod scenario;
pub mod schema;
pub mod steering;
pub mod template;
pub mod terrain;
pub mod tum;
pub mod urdf;
pub mod waypoints;
