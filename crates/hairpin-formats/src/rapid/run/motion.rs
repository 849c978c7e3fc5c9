//! Moves, and what about them is not modelled.

use std::collections::{BTreeMap, BTreeSet};

use hairpin::trajectory::program::{Motion, Move, Speed, Zone};

use super::Machine;
use crate::listing::{At, Class, Doubt, Unmodelled, beside};
use crate::rapid::instructions::{self, MoveKind};
use crate::rapid::kinds::DataKind;
use crate::rapid::predefined;
use crate::rapid::syntax::{Argument, Expression, Path};
use crate::rapid::value::{self, Unfit, Value, Variable};

/// Optional arguments that leave the path as it is.
const INERT: [&str; 3] = ["conc", "inpos", "noeoffs"];
/// Optional arguments that are followed.
const HEEDED: [&str; 5] = ["v", "t", "z", "wobj", "tload"];
/// Optional arguments that change the path as nothing here does.
const CHANGING: [(&str, Unmodelled); 2] = [("id", Unmodelled::MultiMove), ("corr", Unmodelled::Corrections)];

pub(super) type Named<'b> = BTreeMap<&'b str, Option<&'b Expression>>;

/// Why a move is not to be counted on: what is not modelled, where that is known, and words.
#[derive(Debug, Default)]
pub(super) struct Doubts(Vec<Doubt>);

impl Doubts {
    pub(super) fn push(&mut self, unmodelled: Option<Unmodelled>, what: String) {
        self.0.push((unmodelled, what));
    }

    /// All of them: the first one that has a name gives it.
    fn told(self) -> Option<(Option<Unmodelled>, String)> {
        let named = self.0.iter().find_map(|(unmodelled, _)| *unmodelled);
        let words: Vec<String> = self.0.into_iter().map(|(_, what)| what).collect();
        (!words.is_empty()).then(|| (named, words.join("; ")))
    }
}

impl Machine<'_> {
    /// Executes a move, with a procedure in the middle of its corner where the instruction, `name` in lower case, is
    /// one that calls.
    pub(super) fn go(&mut self, kind: MoveKind, name: &str, arguments: &[Argument], at: At) {
        let (placed, named) = self.sort(arguments);
        let calls = name.ends_with("sync");
        let most = least(kind) + instructions::beside(name);
        if placed.len() > most {
            let what = format!("takes {most} arguments without a backslash at most, found {}", placed.len());
            return self.mark(at, Class::ChangesMotion, what);
        }
        if let Some(name) = repeated(arguments) {
            return self.mark(at, Class::ChangesMotion, format!("\\{name} is given twice"));
        }
        match self.movement(kind, &placed, &named, at) {
            Ok((m, mut doubts)) => {
                // Of what the path does not need, calls alone matter: outputs and their values, `\Inpos`.
                let aside = placed.iter().skip(least(kind) + usize::from(calls)).copied();
                let named = named.iter().filter(|(name, _)| !HEEDED.contains(*name)).filter_map(|(_, value)| *value);
                for value in aside.chain(named) {
                    self.evaluate(value, at);
                }
                if calls {
                    let name = placed.get(least(kind));
                    self.in_corner(name.copied(), at, &mut doubts);
                }
                self.moves.push(m);
                match doubts.told() {
                    None => self.mark(at, Class::Understood, ""),
                    Some((unmodelled, what)) => {
                        // The move itself is not to be counted on either.
                        self.mark_before_last(at, unmodelled, what);
                    }
                }
            }
            Err(what) => self.mark(at, Class::ChangesMotion, what),
        }
    }

    /// The procedure of a move: the program may be far ahead when it comes, so what it assigns is never known.
    fn in_corner(&mut self, name: Option<&Expression>, at: At, doubts: &mut Doubts) {
        let Some(Value::Text(name)) = name.map(|name| self.evaluate(name, at)) else {
            return doubts.push(Some(Unmodelled::Triggers), "which procedure it calls is not known".into());
        };
        let name = name.rsplit(':').next().unwrap_or_default();
        let Some(routine) = self.routine(&name.to_ascii_lowercase()) else {
            let what = format!("procedure `{}` is not in this file: what it does is not known", name.escape_debug());
            return doubts.push(Some(Unmodelled::Triggers), what);
        };
        self.ran.insert(routine.at);
        self.mark(routine.at, Class::Harmless, "called in the corner of a move: not followed");
        let effects = self.effects_of(routine);
        for (module, name) in effects.assigned {
            self.make_volatile(module, &name);
        }
        if effects.moves || super::effects::ends(&routine.body) {
            let what = format!("procedure `{}` may change motion in the corner of the move", routine.name);
            doubts.push(Some(Unmodelled::Triggers), what);
        }
    }

    fn mark_before_last(&mut self, at: At, unmodelled: Option<Unmodelled>, what: String) {
        let first = self.unclear.is_none();
        self.mark_as(at, Class::ChangesMotion, what, unmodelled);
        if first {
            self.unclear = Some((self.moves.len() - 1, at.line));
        }
    }

    /// The move, and what about it is doubtful.
    fn movement(
        &mut self,
        kind: MoveKind,
        placed: &[&Expression],
        named: &Named<'_>,
        at: At,
    ) -> Result<(Move, Doubts), Unfit> {
        let mut doubts = Doubts::default();
        let circular = usize::from(kind == MoveKind::Circular);
        let expected = least(kind);
        if placed.len() < expected {
            return Err(format!("a move needs {expected} arguments without a backslash, found {}", placed.len()));
        }
        let to = placed[circular];
        let motion = match kind {
            MoveKind::AbsoluteJoint => {
                let (value, name) = self.data(to, DataKind::JointTarget, at)?;
                Motion::AbsoluteJoint(
                    value::joint_target(&value, name.as_deref()).map_err(|what| self.about(to, what))?,
                )
            }
            MoveKind::Joint => Motion::Joint(self.pose_target(to, at)?),
            MoveKind::Linear => Motion::Linear(self.pose_target(to, at)?),
            MoveKind::Circular => {
                Motion::Circular { via: self.pose_target(placed[0], at)?, to: self.pose_target(to, at)? }
            }
        };
        let speed = self.speed(placed[1 + circular], named.get("v").copied().flatten(), at)?;
        let zone = self.zone(placed[2 + circular], named.get("z").copied().flatten(), at)?;
        let duration = match named.get("t").copied().flatten() {
            Some(duration) => Some(self.number(duration, at)?),
            None => None,
        };
        let tool = self.tool(placed[3 + circular], at, &mut doubts)?;
        let work_object = self.work_object(named.get("wobj").copied().flatten(), at, &mut doubts)?;
        if let Some(axes) = moved_beside(&motion) {
            doubts.0.push(axes);
        }
        if let Some(load) = named.get("tload").copied().flatten()
            && !self.is_no_load(load, at)
        {
            doubts.push(Some(Unmodelled::Payload), "\\TLoad: not the load of the tool".into());
        }
        for name in named.keys().filter(|name| !INERT.contains(*name) && !HEEDED.contains(*name)) {
            let known = CHANGING.iter().find(|(known, _)| known == name).map(|(_, what)| *what);
            doubts.push(known, format!("\\{name} is not followed"));
        }
        let demanded = match kind {
            MoveKind::AbsoluteJoint => true,
            MoveKind::Joint => {
                self.found.joint |= !self.said.joint;
                self.demanded.joint
            }
            MoveKind::Linear | MoveKind::Circular => {
                self.found.linear |= !self.said.linear;
                self.demanded.linear
            }
        };
        let (tool, work_object) = (self.tool_index(tool), self.work_object_index(work_object));
        let m = Move {
            motion,
            speed,
            zone,
            duration,
            tool,
            work_object,
            configuration_demanded: demanded,
            line: Some(at.line),
        };
        Ok((m, doubts))
    }

    /// A value of the kind, with its name if it is data of the modules as it was declared.
    pub(super) fn data(
        &mut self,
        expression: &Expression,
        kind: DataKind,
        at: At,
    ) -> Result<(Value, Option<String>), Unfit> {
        let name = match expression {
            Expression::Path(path) if path.steps.is_empty() => {
                if self.find(&path.name).is_none() && predefined::value(&path.name.to_ascii_lowercase()).is_none() {
                    return Err(format!("`{}` is not declared in this file", path.name));
                }
                self.declared(&path.name).map(|Variable { name, .. }| name.clone())
            }
            _ => None,
        };
        let value = self.evaluate(expression, at).into_kind(kind).map_err(|what| self.about(expression, what))?;
        if value == Value::Unknown {
            let unknown = self.unknown_in(expression, at);
            return Err(self.about(unknown, "is not known from this file".into()));
        }
        Ok((value, name))
    }

    /// What makes a value one that is not known: the first variable in it that is not, or all of it.
    fn unknown_in<'e>(&mut self, expression: &'e Expression, at: At) -> &'e Expression {
        let mut found = Vec::new();
        variables(expression, &mut found);
        let unknown =
            |part: &&Expression| matches!(part, Expression::Path(path) if self.look(path, at) == Value::Unknown);
        found.into_iter().find(unknown).unwrap_or(expression)
    }

    /// The reason with the name of what it is about.
    pub(super) fn about(&self, expression: &Expression, what: Unfit) -> Unfit {
        match expression {
            Expression::Path(Path { name, .. }) | Expression::Call { name, .. } => format!("`{name}` {what}"),
            _ => format!("a value {what}"),
        }
    }

    fn pose_target(
        &mut self,
        expression: &Expression,
        at: At,
    ) -> Result<hairpin::trajectory::program::PoseTarget, Unfit> {
        let (value, name) = self.data(expression, DataKind::RobTarget, at)?;
        value::pose_target(&value, name.as_deref()).map_err(|what| self.about(expression, what))
    }

    fn number(&mut self, expression: &Expression, at: At) -> Result<f64, Unfit> {
        let number = self.evaluate(expression, at).number();
        number.ok_or_else(|| self.about(expression, "is not a number that is known".into()))
    }

    fn speed(&mut self, expression: &Expression, tcp: Option<&Expression>, at: At) -> Result<Speed, Unfit> {
        let predefined = self.undeclared(expression).and_then(Speed::predefined);
        let mut speed = match predefined {
            Some(speed) => speed,
            None => {
                let (value, name) = self.data(expression, DataKind::SpeedData, at)?;
                let speed = value::speed(&value, name.as_deref()).map_err(|what| self.about(expression, what))?;
                endless(speed)
            }
        };
        if let Some(tcp) = tcp {
            speed = Speed { name: None, tcp: self.number(tcp, at)? / 1000.0, ..speed };
        }
        Ok(speed)
    }

    fn zone(&mut self, expression: &Expression, tcp: Option<&Expression>, at: At) -> Result<Zone, Unfit> {
        let predefined = self.undeclared(expression).and_then(Zone::predefined);
        let mut zone = match predefined {
            Some(zone) => zone,
            None => {
                let (value, name) = self.data(expression, DataKind::ZoneData, at)?;
                value::zone(&value, name.as_deref()).map_err(|what| self.about(expression, what))?
            }
        };
        if let Some(tcp) = tcp {
            zone = Zone { name: None, tcp: self.number(tcp, at)? / 1000.0, ..zone };
        }
        Ok(zone)
    }

    /// Arguments by place and by name; conditional ones if their condition holds.
    pub(super) fn sort<'b>(&self, arguments: &'b [Argument]) -> (Vec<&'b Expression>, Named<'b>) {
        let (mut placed, mut named) = (Vec::new(), BTreeMap::new());
        for argument in arguments {
            match argument {
                Argument::Placed(value) => placed.push(value),
                Argument::Named { name, value } => {
                    named.insert(name.as_str(), value.as_ref());
                }
                Argument::IfGiven { name, parameter } => {
                    if self.is_given(parameter) {
                        named.insert(name.as_str(), Some(parameter));
                    }
                }
            }
        }
        (placed, named)
    }
}

/// An optional argument that stands there twice.
pub(super) fn repeated(arguments: &[Argument]) -> Option<&str> {
    let mut names = BTreeSet::new();
    let named = arguments.iter().filter_map(|argument| match argument {
        Argument::Placed(_) => None,
        Argument::Named { name, .. } | Argument::IfGiven { name, .. } => Some(name.as_str()),
    });
    named.into_iter().find(|name| !names.insert(*name))
}

/// How many arguments without a backslash a move has at least.
fn least(kind: MoveKind) -> usize {
    4 + usize::from(kind == MoveKind::Circular)
}

/// A speed without end has the one name under which it can be written.
fn endless(speed: Speed) -> Speed {
    Speed::predefined("vmax").filter(|vmax| vmax.same_as(&speed)).unwrap_or(speed)
}

/// The external axes that the move's end puts somewhere; those of an arc's point on the way are nobody's.
fn moved_beside(motion: &Motion) -> Option<Doubt> {
    let external = match motion {
        Motion::AbsoluteJoint(to) => &to.external,
        Motion::Joint(to) | Motion::Linear(to) | Motion::Circular { to, .. } => &to.external,
    };
    beside(external, ["eax_a", "eax_b", "eax_c", "eax_d", "eax_e", "eax_f"])
}

/// The variables of a value, from left to right.
fn variables<'e>(expression: &'e Expression, found: &mut Vec<&'e Expression>) {
    match expression {
        Expression::Path(_) => found.push(expression),
        Expression::Call { arguments, .. } => {
            arguments.iter().filter_map(handed).for_each(|part| variables(part, found));
        }
        _ => expression.parts().into_iter().for_each(|part| variables(part, found)),
    }
}

/// The value of an argument that has one of its own.
fn handed(argument: &Argument) -> Option<&Expression> {
    match argument {
        Argument::Placed(value) => Some(value),
        Argument::Named { value, .. } => value.as_ref(),
        Argument::IfGiven { .. } => None,
    }
}
