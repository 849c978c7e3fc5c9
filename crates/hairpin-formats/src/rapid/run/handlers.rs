//! What comes in between: errors, a program pointer that is moved out of a routine, steps backwards. The way without
//! them is followed, and certain; what the arm does where one comes is not.

use super::Machine;
use crate::listing::Unmodelled;
use crate::rapid::syntax::{Routine, Source, Statement, What};
use crate::rapid::walk::each;

impl<'a> Machine<'a> {
    /// Names, once all is executed, each line by which a handler of what was, or may be, may move the arm.
    pub(in crate::rapid) fn name_handlers(&mut self, source: &'a Source) {
        for routine in &source.routines {
            if self.ran.contains(&routine.at) || self.looked_at.contains(&routine.at) {
                self.name_handlers_of(routine);
            }
        }
    }

    fn name_handlers_of(&mut self, routine: &Routine) {
        self.module = routine.home.module;
        for handler in &routine.handlers {
            each(&handler.body, &mut |statement| {
                if self.may_move(statement) && !goes_on(statement) {
                    let (kind, name) = (handler.kind, &routine.name);
                    let what = format!("it may move the arm in the {kind} handler of `{name}`, which is not followed");
                    self.mark_unmodelled(statement.at, Unmodelled::Handlers, what);
                }
            });
        }
    }
}

/// Whether it only goes on along the path that was interrupted, which is followed.
fn goes_on(statement: &Statement) -> bool {
    let resumes = |name: &str| ["startmove", "startmoveretry"].contains(&name.to_ascii_lowercase().as_str());
    matches!(&statement.what, What::Call { name, .. } if resumes(name))
}
