//! Names that controllers take: how they are spelt, which are reserved, which mean something already.

use hairpin::trajectory::program::{Speed, Zone};
use thiserror::Error;

use super::builtin;
use super::instructions;
use super::kinds::DataKind;

/// Longest name.
pub const LONGEST_NAME: usize = 32;

/// Words that cannot be names.
pub(super) const RESERVED: [&str; 57] = [
    "ALIAS",
    "AND",
    "BACKWARD",
    "CASE",
    "CONNECT",
    "CONST",
    "DEFAULT",
    "DIV",
    "DO",
    "ELSE",
    "ELSEIF",
    "ENDFOR",
    "ENDFUNC",
    "ENDIF",
    "ENDMODULE",
    "ENDPROC",
    "ENDRECORD",
    "ENDTEST",
    "ENDTRAP",
    "ENDWHILE",
    "ERROR",
    "EXIT",
    "FALSE",
    "FOR",
    "FROM",
    "FUNC",
    "GOTO",
    "IF",
    "INOUT",
    "LOCAL",
    "MOD",
    "MODULE",
    "NOSTEPIN",
    "NOT",
    "NOVIEW",
    "OR",
    "PERS",
    "PROC",
    "RAISE",
    "READONLY",
    "RECORD",
    "RETRY",
    "RETURN",
    "STEP",
    "SYSMODULE",
    "TASK",
    "TEST",
    "THEN",
    "TO",
    "TRAP",
    "TRUE",
    "TRYNEXT",
    "UNDO",
    "VAR",
    "VIEWONLY",
    "WHILE",
    "WITH",
];

/// Words that are reserved beside those, and data that every controller has.
const TAKEN: [&str; 5] = ["XOR", "tool0", "wobj0", "load0", "pi"];

/// Why a name cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum NameError {
    /// Not spelt as a name.
    #[error("`{name}` must begin with a letter and consist of letters, digits and underscores (ASCII)")]
    Spelling {
        /// The name.
        name: String,
    },
    /// Too long.
    #[error("`{name}` has {length} characters: must have {LONGEST_NAME} at most")]
    Long {
        /// The name.
        name: String,
        /// Its characters.
        length: usize,
    },
    /// A reserved word, or something that controllers have under that name.
    #[error("`{name}` is a name that RAPID or the controller uses itself")]
    Reserved {
        /// The name.
        name: String,
    },
}

/// Checks a name that is to be declared.
///
/// # Errors
/// [`NameError`].
pub fn check_name(name: &str) -> Result<(), NameError> {
    let spelt = name.starts_with(|c: char| c.is_ascii_alphabetic())
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    if !spelt {
        return Err(NameError::Spelling { name: name.into() });
    }
    if name.len() > LONGEST_NAME {
        return Err(NameError::Long { name: name.into(), length: name.len() });
    }
    let taken = RESERVED.iter().chain(&TAKEN).any(|word| name.eq_ignore_ascii_case(word))
        || Speed::predefined(name).is_some()
        || Zone::predefined(name).is_some()
        || DataKind::of(&name.to_ascii_lowercase()).is_some()
        || instructions::is_known(&name.to_ascii_lowercase())
        || builtin::is_known(&name.to_ascii_lowercase());
    if taken { Err(NameError::Reserved { name: name.into() }) } else { Ok(()) }
}

/// The name nearest to `wanted` that passes [`check_name`]: other characters become `_`, `p` goes before what begins
/// with none of the letters or is reserved, and what is too long is cut.
pub fn as_name(wanted: &str) -> String {
    let mut name: String = wanted.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    if !name.starts_with(|c: char| c.is_ascii_alphabetic()) {
        name.insert(0, 'p');
    }
    name.truncate(LONGEST_NAME);
    if check_name(&name).is_err() {
        name.insert_str(0, "p_");
        name.truncate(LONGEST_NAME);
    }
    name
}
