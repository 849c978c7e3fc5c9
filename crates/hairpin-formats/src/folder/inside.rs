//! A campaign's folder may come from elsewhere: what is read and written by its names stays in it. Links are not
//! followed, and names that lead out of it are refused.

use std::fs;
use std::path::{Component, Path, PathBuf};

use super::error::FolderError;

/// The file that `name`, as something in `folder` gives it, stands for.
///
/// # Errors
/// Why it does not lie in the folder, as the end of a sentence.
pub fn inside(folder: &Path, name: &str) -> Result<PathBuf, String> {
    let mut path = folder.to_owned();
    for part in Path::new(name).components() {
        match part {
            Component::CurDir => continue,
            Component::Normal(part) => path.push(part),
            Component::ParentDir | Component::RootDir | Component::Prefix(_) => {
                return Err(format!("must lie in {}: no absolute name, and no `..`", folder.display()));
            }
        }
        if fs::symlink_metadata(&path).is_ok_and(|found| found.is_symlink()) {
            return Err(format!("must lie in {}: {} is a link, and is not followed", folder.display(), path.display()));
        }
    }
    Ok(path)
}

/// Refuses a campaign's folder with anything in it, or in its own `folders`, that is no file and no folder.
///
/// # Errors
/// A link, a pipe, a device; the folder cannot be read.
pub(super) fn refuse_links(path: &Path, folders: &[&str]) -> Result<(), FolderError> {
    look_through(path)?;
    for folder in folders.iter().map(|name| path.join(name)) {
        if folder.is_dir() {
            look_through(&folder)?;
        }
    }
    Ok(())
}

fn look_through(folder: &Path) -> Result<(), FolderError> {
    let refuse = |cause| FolderError::Unreadable { path: folder.into(), cause };
    for entry in fs::read_dir(folder).map_err(refuse)? {
        let entry = entry.map_err(refuse)?;
        let kind = entry.file_type().map_err(refuse)?;
        if kind.is_symlink() {
            return Err(FolderError::Link { path: entry.path() });
        }
        if !kind.is_file() && !kind.is_dir() {
            return Err(FolderError::Special { path: entry.path() });
        }
    }
    Ok(())
}

#[cfg(test)]
#[cfg(unix)]
mod tests {
    use std::os::unix::fs::symlink;

    use super::*;

    #[test]
    fn names_and_links_do_not_lead_out() {
        let place = tempfile::tempdir().unwrap();
        let folder = place.path().join("out");
        fs::create_dir(&folder).unwrap();
        assert_eq!(inside(&folder, "./a/b.csv").unwrap(), folder.join("a/b.csv"));
        for name in ["../b.csv", "a/../../b.csv", "/etc/passwd"] {
            assert!(inside(&folder, name).unwrap_err().contains("no `..`"), "{name}");
        }
        symlink(place.path(), folder.join("up")).unwrap();
        assert!(inside(&folder, "up/b.csv").unwrap_err().contains("is a link"));
        let refused = refuse_links(&folder, &[]).unwrap_err().to_string();
        assert!(refused.contains("up is a link"), "{refused}");
    }
}
