//! What is followed of the instructions around moves.

use super::Machine;
use super::expressions::combine;
use crate::listing::{At, Class, Unmodelled};
use crate::rapid::syntax::{Argument, Expression};
use crate::rapid::value::Value;

impl Machine<'_> {
    /// ConfL, ConfJ, SingArea, AccSet, VelSet, GripLoad, SoftDeact; Incr, Decr, Add, Clear.
    pub(super) fn follow(&mut self, name: &str, arguments: &[Argument], at: At) {
        let (placed, named) = self.sort(arguments);
        let values: Vec<Value> = placed.iter().map(|value| self.evaluate(value, at)).collect();
        named.values().flatten().for_each(|value| drop(self.evaluate(value, at)));
        let numbers: Vec<Option<f64>> = values.iter().map(Value::number).collect();
        match name {
            "confl" | "confj" => {
                let on = !named.contains_key("off");
                if name == "confl" {
                    (self.demanded.linear, self.said.linear) = (on, true);
                } else {
                    (self.demanded.joint, self.said.joint) = (on, true);
                }
                self.mark(at, Class::Understood, "");
            }
            // What controllers start with changes nothing.
            "singarea" if named.contains_key("off") => self.mark(at, Class::Harmless, ""),
            "accset" if named.is_empty() && numbers == [Some(100.0); 2] => self.mark(at, Class::Harmless, ""),
            "velset" if numbers == [Some(100.0), Some(5000.0)] => self.mark(at, Class::Harmless, ""),
            "singarea" => self.mark_unmodelled(at, Unmodelled::Interpolation, "singarea is not followed"),
            "accset" | "velset" => {
                self.mark_unmodelled(at, Unmodelled::Speeds, format!("{name} is not followed"));
            }
            "gripload" => self.grip(&placed, at),
            "softdeact" if self.soft => {
                self.mark_unmodelled(at, Unmodelled::SoftServos, "SoftDeact: servos get stiff again");
            }
            "softdeact" => self.mark(at, Class::Harmless, ""),
            _ => self.adjust(name, &placed, values.get(1), at),
        }
    }

    fn adjust(&mut self, name: &str, placed: &[&Expression], by: Option<&Value>, at: At) {
        let Some(Expression::Path(path)) = placed.first() else {
            return self.mark(at, Class::Harmless, "no variable");
        };
        let by = match name {
            "incr" => Value::Num(1.0),
            "decr" => Value::Num(-1.0),
            "add" => by.cloned().unwrap_or(Value::Unknown),
            _ => Value::Unknown,
        };
        // What is called in the other argument may have changed it.
        let value = if name == "clear" { Value::Num(0.0) } else { combine("+", &self.look(path, at), &by) };
        match self.assign(path, value, at) {
            Ok(()) => self.mark(at, Class::Understood, ""),
            Err(what) => self.mark(at, Class::ChangesMotion, what),
        }
    }
}
