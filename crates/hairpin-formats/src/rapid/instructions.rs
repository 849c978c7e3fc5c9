//! Which instructions move the arm, which do not, and which change how it moves.

/// What an instruction does, as far as motion goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Effect {
    /// Moves the arm in a way that is understood.
    Move(MoveKind),
    /// Sets something that is followed here.
    Followed,
    /// Has nothing to do with motion.
    Harmless,
    /// Has nothing to do with motion, but writes into its arguments.
    Writes,
    /// Changes motion in a way that is not followed.
    Changes,
}

/// The moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum MoveKind {
    AbsoluteJoint,
    Joint,
    Linear,
    Circular,
}

const FOLLOWED: [&str; 9] = ["accset", "add", "clear", "confj", "confl", "decr", "incr", "singarea", "velset"];

const HARMLESS: [&str; 86] = [
    "aliasio",
    "bookerrno",
    "clkreset",
    "clkstart",
    "clkstop",
    "close",
    "closedir",
    "eoffsoff",
    "errlog",
    "errwrite",
    "gripload",
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
    "ivarvalue",
    "iwatch",
    "load",
    "makedir",
    "mechunitload",
    "motionsup",
    "open",
    "opendir",
    "pdispoff",
    "procerrrecovery",
    "pulsedo",
    "removedir",
    "removefile",
    "renamefile",
    "reset",
    "rewind",
    "save",
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
    "softdeact",
    "spystart",
    "spystop",
    "startload",
    "stop",
    "systemstopaction",
    "tperase",
    "tpshow",
    "tpwrite",
    "triggequip",
    "triggint",
    "triggio",
    "triggcheckio",
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
    "waittestandset",
    "waittime",
    "write",
    "writestrbin",
];

const WRITES: [&str; 16] = [
    "copyrawbytes",
    "getdataval",
    "getsysdata",
    "packrawbytes",
    "readanybin",
    "readcfgdata",
    "readerrdata",
    "setdataval",
    "socketreceive",
    "tpreaddnum",
    "tpreadfk",
    "tpreadnum",
    "unpackrawbytes",
    "waituntil",
    "writeanybin",
    "writebin",
];

const CHANGES: [&str; 56] = [
    "actunit",
    "cirpathmode",
    "clearpath",
    "contactl",
    "corrclear",
    "corrcon",
    "corrdiscon",
    "corrwrite",
    "deactunit",
    "egmactjoint",
    "egmactmove",
    "egmactpose",
    "egmmovec",
    "egmmovel",
    "egmrunjoint",
    "egmrunpose",
    "egmstop",
    "eoffson",
    "eoffsset",
    "exitcycle",
    "indamove",
    "indcmove",
    "inddmove",
    "indreset",
    "indrmove",
    "motionprocessmodeset",
    "moveextj",
    "pathacclim",
    "pathrecmovebwd",
    "pathrecmovefwd",
    "pathrecstart",
    "pathrecstop",
    "pathresol",
    "pdispon",
    "pdispset",
    "restopath",
    "searchc",
    "searchextj",
    "searchl",
    "softact",
    "speedrefresh",
    "startmove",
    "startmoveretry",
    "stopmove",
    "stopmovereset",
    "storepath",
    "syncmoveoff",
    "syncmoveon",
    "syncmoveundo",
    "syncmovesuspend",
    "syncmoveresume",
    "triggabsj",
    "triggc",
    "triggj",
    "triggl",
    "worldacclim",
];

/// Endings of moves that do something else at their end: outputs, or a procedure in the middle of the corner.
const ENDINGS: [&str; 5] = ["", "do", "ao", "go", "sync"];

/// What the instruction does; `None` for names that are not ABB's. `name` in lower case.
pub(super) fn effect(name: &str) -> Option<Effect> {
    if let Some(kind) = move_kind(name) {
        return Some(Effect::Move(kind));
    }
    [
        (&FOLLOWED[..], Effect::Followed),
        (&HARMLESS[..], Effect::Harmless),
        (&WRITES[..], Effect::Writes),
        (&CHANGES[..], Effect::Changes),
    ]
    .into_iter()
    .find_map(|(names, effect)| names.contains(&name).then_some(effect))
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
