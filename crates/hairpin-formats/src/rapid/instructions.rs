//! Which instructions move the arm, which do not, and which change how it moves.

use super::unmodelled;
use crate::listing::Unmodelled;

/// What an instruction does, as far as motion goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Effect {
    /// Moves the arm in a way that is understood.
    Move(MoveKind),
    /// Sets something that is followed here.
    Followed,
    /// Has nothing to do with motion, and writes at most into what [`super::outputs`] names.
    Harmless,
    /// Has nothing to do with motion, but writes into its arguments.
    Writes,
    /// Changes motion in a way that is not followed.
    Changes(Unmodelled),
}

/// The moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum MoveKind {
    AbsoluteJoint,
    Joint,
    Linear,
    Circular,
}

const FOLLOWED: [&str; 11] =
    ["accset", "add", "clear", "confj", "confl", "decr", "gripload", "incr", "singarea", "softdeact", "velset"];

const HARMLESS: [&str; 109] = [
    "aliasio",
    "break",
    "cancelload",
    "checkprogref",
    "cleariobuff",
    "clearrawbytes",
    "clkreset",
    "clkstart",
    "clkstop",
    "close",
    "closedir",
    "copyfile",
    "cornerpathwarning",
    "eoffsoff",
    "errlog",
    "errraise",
    "errwrite",
    "idelete",
    "idisable",
    "ienable",
    "ierror",
    "invertdo",
    "iodisable",
    "ioenable",
    "ipers",
    "isignalai",
    "isignalao",
    "isignaldi",
    "isignaldo",
    "isignalgi",
    "isignalgo",
    "isleep",
    "itimer",
    "iwatch",
    "load",
    "makedir",
    "motionsup",
    "open",
    "opendir",
    "pathlengthreset",
    "pathlengthstart",
    "pathlengthstop",
    "pdispoff",
    "procerrrecovery",
    "pulsedo",
    "raisetouser",
    "removedir",
    "removefile",
    "renamefile",
    "reset",
    "resetppmoved",
    "resetretrycount",
    "rewind",
    "rmqemptyqueue",
    "rmqsendmessage",
    "rmqsendwait",
    "save",
    "savecfgdata",
    "scwrite",
    "set",
    "setallapplerr",
    "setao",
    "setdo",
    "setgo",
    "skipwarn",
    "socketaccept",
    "socketbind",
    "socketclose",
    "socketconnect",
    "socketcreate",
    "socketlisten",
    "socketsend",
    "spystart",
    "spystop",
    "startload",
    "stop",
    "systemstopaction",
    "testsigndefine",
    "testsignreset",
    "texttabinstall",
    "tperase",
    "tpshow",
    "tpwrite",
    "triggcheckio",
    "triggdatacopy",
    "triggdatareset",
    "triggequip",
    "triggint",
    "triggio",
    "triggrampao",
    "tunereset",
    "uimsgbox",
    "uishow",
    "unload",
    "waitai",
    "waitao",
    "waitdi",
    "waitdo",
    "waitgi",
    "waitgo",
    "waitload",
    "waitrob",
    "waitsynctask",
    "waittime",
    "write",
    "writecfgdata",
    "writerawbytes",
    "writestrbin",
    "writevar",
];

const WRITES: [&str; 23] = [
    "bitclear",
    "bitset",
    "bookerrno",
    "copyrawbytes",
    "getdataval",
    "getsysdata",
    "gettrapdata",
    "ivarvalue",
    "packrawbytes",
    "readanybin",
    "readcfgdata",
    "readerrdata",
    "readrawbytes",
    "readvararr",
    "socketreceive",
    "tpreaddnum",
    "tpreadfk",
    "tpreadnum",
    "unpackrawbytes",
    "waittestandset",
    "waituntil",
    "writeanybin",
    "writebin",
];

/// Endings of moves that do something else at their end: outputs, or a procedure in the middle of the corner.
const ENDINGS: [&str; 5] = ["", "do", "ao", "go", "sync"];

/// How many arguments without a backslash a move has at most behind those of its path; `name` in lower case.
pub(super) fn beside(name: &str) -> usize {
    match name {
        "moveabsj" => 0,
        _ if name.ends_with("sync") => 1,
        // A signal and its value.
        _ if ["do", "ao", "go"].iter().any(|ending| name.ends_with(ending)) => 2,
        _ => 0,
    }
}

/// What the instruction does; `None` for names that are not ABB's. `name` in lower case.
pub(super) fn effect(name: &str) -> Option<Effect> {
    if let Some(kind) = move_kind(name) {
        return Some(Effect::Move(kind));
    }
    let plain = [(&FOLLOWED[..], Effect::Followed), (&HARMLESS[..], Effect::Harmless), (&WRITES[..], Effect::Writes)]
        .into_iter()
        .find_map(|(names, effect)| names.contains(&name).then_some(effect));
    plain.or_else(|| unmodelled::of(name).map(Effect::Changes))
}

/// Whether the name (lower case) is an instruction of ABB's.
pub(super) fn is_known(name: &str) -> bool {
    effect(name).is_some()
}

fn move_kind(name: &str) -> Option<MoveKind> {
    let rest = name.strip_prefix("move")?;
    if rest == "absj" {
        return Some(MoveKind::AbsoluteJoint);
    }
    let kind = match rest.get(..1)? {
        "l" => MoveKind::Linear,
        "j" => MoveKind::Joint,
        "c" => MoveKind::Circular,
        _ => return None,
    };
    ENDINGS.contains(&&rest[1..]).then_some(kind)
}
