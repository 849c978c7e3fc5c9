//! Choices of a path with loops for what it leaves out, and what follows from them, by going over all rules.
//!
//! Fixpoint of all rules, looked at one after the other until none changes anything: what the search propagates by
//! queues.
//!
//! ```text
//! directed     each point: exactly one of {arcs out, end, loop} and exactly one of {arcs in, start, loop}
//! undirected   each point: two of {arcs, start, end} and no loop, or the loop alone
//! all          exactly one start, exactly one end, no circle of chosen arcs
//! ```

/// May be in or out.
pub(super) const OPEN: u8 = 0;
/// No path of what is left has it.
pub(super) const OUT: u8 = 1;
/// Every path of what is left has it.
pub(super) const IN: u8 = 2;

/// The table, and how choices are numbered.
pub(super) struct Layout<'a> {
    /// n.
    pub(super) points: usize,
    /// Whether i→j and j→i are two choices.
    pub(super) directed: bool,
    /// In rows, unscaled.
    pub(super) costs: &'a [Option<i64>],
    /// What costs are multiplied by.
    pub(super) scale: i64,
}

impl Layout<'_> {
    /// n² + 3n: arcs (the diagonal has numbers, too), starts, loops, ends.
    pub(super) fn len(&self) -> usize {
        self.points * (self.points + 3)
    }

    /// The choice that the path begins at `point`.
    pub(super) fn start(&self, point: usize) -> usize {
        self.points * self.points + point
    }

    /// The choice that `point` is left out.
    pub(super) fn looped(&self, point: usize) -> usize {
        self.points * (self.points + 1) + point
    }

    /// The choice that the path ends at `point`.
    pub(super) fn end(&self, point: usize) -> usize {
        self.points * (self.points + 2) + point
    }

    /// The choice of the arc; an undirected one has one number.
    pub(super) fn arc(&self, from: usize, to: usize) -> usize {
        if self.directed || from < to { from * self.points + to } else { to * self.points + from }
    }

    /// Scaled cost of the arc with this number.
    pub(super) fn cost(&self, arc: usize) -> Option<i128> {
        self.costs[arc].map(|cost| i128::from(cost) * i128::from(self.scale))
    }
}

/// What is chosen so far.
#[derive(Clone)]
pub(super) struct Chosen {
    /// [`OPEN`], [`OUT`] or [`IN`] by number.
    pub(super) state: Vec<u8>,
}

impl Chosen {
    /// What the table and the ends say.
    ///
    /// Missing arcs, the diagonal and, of undirected tables, the second number of each arc are out, and so are ends
    /// that are not the fixed ones.
    pub(super) fn new(layout: &Layout<'_>, start: Option<usize>, end: Option<usize>) -> Self {
        let n = layout.points;
        let mut state = vec![OPEN; layout.len()];
        for from in 0..n {
            for to in 0..n {
                if from == to || layout.costs[from * n + to].is_none() || layout.arc(from, to) != from * n + to {
                    state[from * n + to] = OUT;
                }
            }
            if start.is_some_and(|start| start != from) {
                state[layout.start(from)] = OUT;
            }
            if end.is_some_and(|end| end != from) {
                state[layout.end(from)] = OUT;
            }
        }
        Self { state }
    }

    /// With one choice more; `None` if that is against what is chosen.
    pub(super) fn with(mut self, layout: &Layout<'_>, choice: usize, state: u8) -> Option<Self> {
        let now = *self.state.get(choice)?;
        if now != OPEN && now != state {
            return None;
        }
        self.state[choice] = state;
        self.closed(layout)
    }

    /// With all that follows; `None` if it contradicts itself.
    ///
    /// O(n²) a round, at most as many rounds as there are choices.
    pub(super) fn closed(mut self, layout: &Layout<'_>) -> Option<Self> {
        loop {
            let before = self.state.clone();
            for point in 0..layout.points {
                let out = (0..layout.points).filter(|to| *to != point).map(|to| layout.arc(point, to));
                let leaving = out.chain([layout.end(point)]).collect::<Vec<_>>();
                let into = (0..layout.points).filter(|from| *from != point).map(|from| layout.arc(from, point));
                let entering = into.chain([layout.start(point)]).collect::<Vec<_>>();
                if layout.directed {
                    let with_loop = |mut choices: Vec<usize>| {
                        choices.push(layout.looped(point));
                        choices
                    };
                    self.exactly_one(&with_loop(leaving))?;
                    self.exactly_one(&with_loop(entering))?;
                } else {
                    let mut beside = leaving;
                    beside.push(layout.start(point));
                    self.two_or_loop(&beside, layout.looped(point))?;
                }
            }
            self.exactly_one(&(0..layout.points).map(|point| layout.start(point)).collect::<Vec<_>>())?;
            self.exactly_one(&(0..layout.points).map(|point| layout.end(point)).collect::<Vec<_>>())?;
            self.no_circle(layout)?;
            if self.state == before {
                return Some(self);
            }
        }
    }

    /// How many of these are in that state.
    fn count(&self, choices: &[usize], state: u8) -> usize {
        choices.iter().filter(|choice| self.state[**choice] == state).count()
    }

    /// Those that are open get this state.
    fn set_open(&mut self, choices: &[usize], state: u8) {
        for choice in choices {
            if self.state[*choice] == OPEN {
                self.state[*choice] = state;
            }
        }
    }

    /// `None` where none can be or two are.
    fn exactly_one(&mut self, choices: &[usize]) -> Option<()> {
        let (chosen, open) = (self.count(choices, IN), self.count(choices, OPEN));
        match (chosen, open) {
            (0, 0) | (2.., _) => return None,
            (0, 1) => self.set_open(choices, IN),
            (1, _) => self.set_open(choices, OUT),
            _ => {}
        }
        Some(())
    }

    /// Two of these, or the loop and none of these.
    ///
    /// `beside` are the arcs of a point, its start and its end: a path of one point alone has both of its two there.
    fn two_or_loop(&mut self, beside: &[usize], looped: usize) -> Option<()> {
        let (chosen, open) = (self.count(beside, IN), self.count(beside, OPEN));
        if chosen > 2 || chosen > 0 && self.state[looped] == IN || chosen + open < 2 && self.state[looped] == OUT {
            return None;
        }
        if chosen > 0 {
            self.state[looped] = OUT;
        }
        if chosen + open < 2 {
            if chosen > 0 {
                return None;
            }
            self.state[looped] = IN;
        }
        match self.state[looped] {
            IN => self.set_open(beside, OUT),
            _ if chosen == 2 => self.set_open(beside, OUT),
            OUT if chosen + open == 2 => self.set_open(beside, IN),
            _ => {}
        }
        Some(())
    }

    /// Chosen arcs are chains; what would close one is out.
    ///
    /// Union by renaming, O(n²) an arc: no structure that could share a mistake with the search's.
    fn no_circle(&mut self, layout: &Layout<'_>) -> Option<()> {
        let n = layout.points;
        let mut chain: Vec<usize> = (0..n).collect();
        for arc in (0..n * n).filter(|arc| self.state[*arc] == IN) {
            let (a, b) = (chain[arc / n], chain[arc % n]);
            if a == b {
                return None;
            }
            chain.iter_mut().filter(|chain| **chain == b).for_each(|chain| *chain = a);
        }
        for arc in (0..n * n).filter(|arc| arc / n != arc % n) {
            if self.state[arc] == OPEN && chain[arc / n] == chain[arc % n] {
                self.state[arc] = OUT;
            }
        }
        Some(())
    }
}
