//! A campaign's folder, opened to be read.

use std::path::Path;

use hairpin::campaign::Setup;
use hairpin::math::simd::Simd;
use hairpin_formats::folder::CampaignFolder;
use hairpin_formats::scenario::{check_asked, read_kept};

use super::campaign::Work;
use super::unchanged::same_as_made;
use crate::Problem;
use crate::sets::Set;

/// Opens a campaign folder to read it.
///
/// # Errors
/// There is no campaign in it, or its scenario is broken.
pub fn open_to_read(path: &Path) -> Result<Work, Problem> {
    open_with(path, &[])
}

/// The same, for what is said of its cases and runs.
///
/// # Errors
/// As of [`same_as_made`].
pub(crate) fn open_as_made(path: &Path) -> Result<Work, Problem> {
    let work = open_to_read(path)?;
    same_as_made(&work.folder, &work.setup, &[])?;
    Ok(work)
}

/// The same with other values of `sets`.
pub(crate) fn open_with(path: &Path, sets: &[Set]) -> Result<Work, Problem> {
    let folder = CampaignFolder::open(path)?;
    let setup = resolve(&folder, sets)?;
    Ok(Work { folder, setup })
}

/// Opens a campaign folder to read it, its scenario changed by `sets` here and not there.
///
/// # Errors
/// As of [`open_to_read`]; a key that does not fit.
pub(crate) fn open_to_read_as(path: &Path, sets: &[Set]) -> Result<Work, Problem> {
    let folder = CampaignFolder::open(path)?;
    let setup = resolve(&folder, sets)?;
    check_asked(&setup.scenario, &folder.file("scenario.toml"))?;
    Ok(Work { folder, setup })
}

/// What its scenario describes once `sets` change it, with the version of the kernels that goes on with it.
pub(super) fn resolve(folder: &CampaignFolder, sets: &[Set]) -> Result<Setup, Problem> {
    let name = folder.file("scenario.toml");
    let setup = read_kept(&folder.read_scenario()?, &name.to_string_lossy(), folder.path(), sets)?;
    // What stands at its end says that nothing was cut off: keys that are gone would be taken for those not given.
    let Some(level) = folder.simd_level()? else {
        let bound = "must end with `[made_by]`: version, root_seed, simd; it was cut, or is not this folder's";
        return Err(Problem::input(format!("{}: {bound}", name.display())));
    };
    Ok(setup.with_simd(if level == Simd::Portable.level() { Simd::Portable } else { Simd::Widest }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::generated;

    #[test]
    fn a_scenario_that_lost_its_end_is_refused() {
        let (_place, folder) = generated();
        let file = folder.join("scenario.toml");
        let whole = std::fs::read_to_string(&file).unwrap();
        let lines = whole.split_inclusive('\n').collect::<Vec<_>>();
        for kept in 0..lines.len() {
            std::fs::write(&file, lines[..kept].concat()).unwrap();
            assert!(open_to_read(&folder).is_err(), "{kept} of {} lines", lines.len());
        }
        let without = whole.split("[made_by]").next().unwrap();
        std::fs::write(&file, without).unwrap();
        let told = open_to_read(&folder).map(|_| ()).unwrap_err().to_string();
        assert!(told.contains("must end with `[made_by]`"), "{told}");
    }
}
