//! The session of one shopper as a state machine of four states. It knows only the time and the presence of a person: a
//! window, a service without one and a test drive the same machine.

use serde::Serialize;

toile_base::named! {
    /// The states of a session, in their order.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum SessionState {
        /// No person is in view: the mirror shows what it can do.
        Attract = "attract",
        /// A person stands there and is measured.
        Measuring = "measuring",
        /// They see themselves dressed.
        TryOn = "try-on",
        /// They have left, or no person is in view: what is known of them is about to be wiped.
        Left = "left",
    }
}

/// Times of a session.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SessionTimes {
    /// Time in view after which a person has stepped in (ns): a passer-by has not.
    pub step_in_ns: u64,
    /// Time without a person in view after which the shopper has left (ns): a turn or a lost frame is no leave.
    pub step_out_ns: u64,
    /// Time from then until everything is wiped (ns): a shopper who comes back before goes on where they were.
    pub wipe_ns: u64,
}

/// The input of an update.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct SessionInput {
    /// Whether a shopper is seen.
    pub shopper: bool,
    /// Whether a body of their measures stands dressed.
    pub dressed: bool,
}

/// A change of state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StateChange {
    /// The state that was left.
    pub from: SessionState,
    /// The state from now on.
    pub to: SessionState,
}

/// The state machine of a session, from the first visitor seen to all wiped.
#[derive(Debug, Clone)]
pub struct SessionMachine {
    times: SessionTimes,
    state: SessionState,
    /// When the state was entered (ns).
    entered_ns: u64,
    /// Whether a shopper was seen in the last update, and since when that is so (ns).
    seen: bool,
    since_ns: u64,
}

impl SessionMachine {
    /// No person is in view, at this time (ns).
    pub fn new(times: SessionTimes, now_ns: u64) -> Self {
        Self { times, state: SessionState::Attract, entered_ns: now_ns, seen: false, since_ns: now_ns }
    }

    /// State of the session now.
    pub fn state(&self) -> SessionState {
        self.state
    }

    /// How long the state has lasted (ns): what a countdown shows.
    pub fn lasted_ns(&self, now_ns: u64) -> u64 {
        now_ns.saturating_sub(self.entered_ns)
    }

    /// Takes what is seen now; returns the change of state, where there is one. At most one an update.
    pub fn update(&mut self, now_ns: u64, input: SessionInput) -> Option<StateChange> {
        if input.shopper != self.seen {
            (self.seen, self.since_ns) = (input.shopper, now_ns);
        }
        let for_ns = now_ns.saturating_sub(self.since_ns);
        let stepped_in = self.seen && for_ns >= self.times.step_in_ns;
        let stepped_out = !self.seen && for_ns >= self.times.step_out_ns;
        let to = match self.state {
            SessionState::Attract if stepped_in => SessionState::Measuring,
            SessionState::Measuring | SessionState::TryOn if stepped_out => SessionState::Left,
            SessionState::Measuring if input.dressed && self.seen => SessionState::TryOn,
            SessionState::Left if stepped_in && input.dressed => SessionState::TryOn,
            SessionState::Left if stepped_in => SessionState::Measuring,
            SessionState::Left if self.lasted_ns(now_ns) >= self.times.wipe_ns => SessionState::Attract,
            _ => return None,
        };
        let from = std::mem::replace(&mut self.state, to);
        self.entered_ns = now_ns;
        Some(StateChange { from, to })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: u64 = 1_000_000;
    const TIMES: SessionTimes = SessionTimes { step_in_ns: 500 * MS, step_out_ns: 2_000 * MS, wipe_ns: 5_000 * MS };

    /// The states that a session goes through: spans of what is seen, in ms; an update each 10 ms.
    fn visited(spans: &[(u64, bool, bool)]) -> Vec<(u64, SessionState)> {
        let (mut session, mut now, mut states) = (SessionMachine::new(TIMES, 0), 0, Vec::new());
        for (length, shopper, dressed) in spans {
            for _ in 0..length / 10 {
                now += 10;
                if let Some(change) = session.update(now * MS, SessionInput { shopper: *shopper, dressed: *dressed }) {
                    assert_eq!(change.to, session.state());
                    assert_ne!(change.from, change.to);
                    states.push((now, change.to));
                }
            }
        }
        states
    }

    #[test]
    fn a_visit_goes_through_all_states() {
        let states = visited(&[(1_000, false, false), (1_000, true, false), (4_000, true, true), (8_000, false, true)]);
        let expected = [
            (1_510, SessionState::Measuring),
            (2_010, SessionState::TryOn),
            (8_010, SessionState::Left),
            (13_010, SessionState::Attract),
        ];
        assert_eq!(states, expected);
    }

    #[test]
    fn a_passer_by_and_a_lost_frame_change_nothing() {
        assert!(visited(&[(490, true, false), (100, false, false), (490, true, false)]).is_empty());
        let blink = visited(&[(600, true, false), (1_900, false, true), (1_000, true, true)]);
        assert_eq!(blink.iter().map(|s| s.1).collect::<Vec<_>>(), [SessionState::Measuring, SessionState::TryOn]);
    }

    #[test]
    fn who_comes_back_in_time_goes_on_and_who_comes_later_begins_anew() {
        let names = |spans: &[(u64, bool, bool)]| visited(spans).iter().map(|s| s.1).collect::<Vec<_>>();
        let back = names(&[(600, true, true), (3_000, false, true), (1_000, true, true)]);
        assert_eq!(back, [SessionState::Measuring, SessionState::TryOn, SessionState::Left, SessionState::TryOn]);
        let unmeasured = names(&[(600, true, false), (3_000, false, false), (1_000, true, false)]);
        assert_eq!(unmeasured, [SessionState::Measuring, SessionState::Left, SessionState::Measuring]);
        let late = names(&[(600, true, true), (7_500, false, true), (1_000, true, false)]);
        assert_eq!(
            late,
            [
                SessionState::Measuring,
                SessionState::TryOn,
                SessionState::Left,
                SessionState::Attract,
                SessionState::Measuring
            ]
        );
    }

    #[test]
    fn an_absent_shopper_is_not_dressed() {
        let gone = visited(&[(600, true, false), (1_500, false, true)]);
        assert_eq!(gone.iter().map(|s| s.1).collect::<Vec<_>>(), [SessionState::Measuring], "dressed, but not seen");
    }

    #[test]
    fn names_are_those_of_the_json() {
        for state in SessionState::ALL {
            assert_eq!(serde_json::to_value(state).unwrap(), state.name());
        }
    }
}
