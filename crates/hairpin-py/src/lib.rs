//! The Python door: what Python calls becomes the settings of a job, and what came of it plain objects. No algorithm
//! and no words of its own; what is comfortable about the package lies in its Python sources, `python/hairpin`.

#![cfg_attr(not(test), deny(clippy::unwrap_used))] // tests may, what meets users' data may not

mod callables;
mod campaigns;
mod command;
mod folders;
mod heaviest;
mod logs;
mod plain;
mod problem;
mod settings;
mod steering;
mod tables;
mod wait;

use hairpin_jobs::bounds;
use pyo3::prelude::*;

/// Everything that the Python sources of the package call.
#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("THREADS", bounds::THREADS.into_inner())?;
    module.add("GRAPHS", bounds::GRAPHS.into_inner())?;
    module.add("VISITS", bounds::VISITS.into_inner())?;
    module.add("PROGRAMS", bounds::PROGRAMS.into_inner())?;
    module.add("LARGEST_SEED", bounds::LARGEST_SEED)?;
    module.add("LONGEST", bounds::LONGEST)?;
    module.add_function(wrap_pyfunction!(command::run, module)?)?;
    module.add_function(wrap_pyfunction!(campaigns::stress, module)?)?;
    module.add_function(wrap_pyfunction!(campaigns::generate, module)?)?;
    module.add_function(wrap_pyfunction!(campaigns::explain, module)?)?;
    module.add_function(wrap_pyfunction!(campaigns::facts, module)?)?;
    module.add_function(wrap_pyfunction!(folders::execute, module)?)?;
    module.add_function(wrap_pyfunction!(folders::judge, module)?)?;
    module.add_function(wrap_pyfunction!(folders::verify, module)?)?;
    module.add_function(wrap_pyfunction!(folders::shrink, module)?)?;
    module.add_function(wrap_pyfunction!(folders::compare, module)?)?;
    module.add_function(wrap_pyfunction!(folders::learn, module)?)?;
    module.add_function(wrap_pyfunction!(folders::report, module)?)?;
    module.add_function(wrap_pyfunction!(folders::read, module)?)?;
    module.add_function(wrap_pyfunction!(heaviest::max_load, module)?)?;
    module.add_function(wrap_pyfunction!(heaviest::max_load_of_cloud, module)?)?;
    module.add_function(wrap_pyfunction!(logs::judge_log, module)?)?;
    module.add_class::<tables::Table>()?;
    module.add_class::<steering::Vehicle>()?;
    module.add_class::<callables::Code>()?;
    Ok(())
}
