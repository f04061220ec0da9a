//! Log messages: the instance collects them and passes them to the host at the end of each call.

use moorline::output::description::LOG_CATEGORIES;
use moorline_host::Status;

/// Kind of a message; each kind has a category in the model description.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Topic {
    /// Choices of the solver, with their reasons.
    Event,
    /// Carried out, with a reservation.
    Warning,
    /// Refused or failed.
    Error,
    /// The instance is unusable.
    Fatal,
}

impl Topic {
    /// Name of the category in the model description.
    pub(crate) fn category(self) -> &'static str {
        LOG_CATEGORIES[self as usize].0
    }

    pub(crate) fn status(self) -> Status {
        match self {
            Topic::Event => Status::Ok,
            Topic::Warning => Status::Warning,
            Topic::Error => Status::Error,
            Topic::Fatal => Status::Fatal,
        }
    }
}

/// Messages not yet sent, and the categories that the host has selected.
#[derive(Debug, Default)]
pub(crate) struct Log {
    enabled: [bool; LOG_CATEGORIES.len()],
    messages: Vec<(Topic, String)>,
}

impl Log {
    /// Returns an empty log with all categories on or off.
    pub(crate) fn new(on: bool) -> Log {
        Log {
            enabled: [on; LOG_CATEGORIES.len()],
            messages: Vec::new(),
        }
    }

    /// Turns categories on or off; an empty list means all. `on` with names turns the others off. An unknown name is returned and changes nothing.
    pub(crate) fn select(&mut self, on: bool, categories: &[&str]) -> Result<(), String> {
        if categories.is_empty() {
            self.enabled = [on; LOG_CATEGORIES.len()];
            return Ok(());
        }
        let mut enabled = if on {
            [false; LOG_CATEGORIES.len()]
        } else {
            self.enabled
        };
        for name in categories {
            let index = LOG_CATEGORIES
                .iter()
                .position(|(category, _)| category == name)
                .ok_or_else(|| (*name).to_string())?;
            enabled[index] = on;
        }
        self.enabled = enabled;
        Ok(())
    }

    /// Returns whether messages of a topic are kept.
    pub(crate) fn keeps(&self, topic: Topic) -> bool {
        self.enabled[topic as usize]
    }

    /// Keeps a message if its category is on.
    pub(crate) fn push(&mut self, topic: Topic, message: impl FnOnce() -> String) {
        if self.keeps(topic) {
            self.messages.push((topic, message()));
        }
    }

    /// Returns whether no messages are pending.
    pub(crate) fn is_empty(&self) -> bool {
        self.messages.is_empty()
    }

    /// Removes and returns the pending messages.
    pub(crate) fn take(&mut self) -> Vec<(Topic, String)> {
        std::mem::take(&mut self.messages)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_kept_while_logging_is_off() {
        let mut log = Log::new(false);
        log.push(Topic::Error, || unreachable!("not even formatted"));
        assert!(log.take().is_empty());
    }

    #[test]
    fn only_the_selected_categories_are_kept() {
        let mut log = Log::new(true);
        log.select(true, &["logStatusError"]).unwrap();
        log.push(Topic::Event, || "event".into());
        log.push(Topic::Error, || "error".into());
        assert_eq!(log.take(), vec![(Topic::Error, "error".into())]);
    }

    #[test]
    fn an_undeclared_category_is_refused_and_changes_nothing() {
        let mut log = Log::new(true);
        assert_eq!(log.select(false, &["logAll"]), Err("logAll".into()));
        log.push(Topic::Event, || "event".into());
        assert_eq!(log.take().len(), 1);
    }

    #[test]
    fn every_topic_has_the_category_of_its_name() {
        let categories = [Topic::Event, Topic::Warning, Topic::Error, Topic::Fatal].map(Topic::category);
        assert_eq!(
            categories,
            [
                "logEvents",
                "logStatusWarning",
                "logStatusError",
                "logStatusFatal"
            ]
        );
    }
}
