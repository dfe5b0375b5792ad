//! What a command has to say.

use anyhow::Result;
use serde_json::Value;

/// The outcome of a command, for programs and for people.
pub(crate) struct Answer {
    /// What `--json` prints; null where the command has printed by itself.
    pub(crate) json: Value,
    /// The exit status.
    pub(crate) status: i32,
    as_json: bool,
    tell: Box<dyn FnOnce()>,
}

impl Answer {
    /// An answer in both forms, of which `--json` (`as_json`) chooses one; `tell` prints that for people.
    pub(crate) fn new(as_json: bool, json: Value, tell: impl FnOnce() + 'static) -> Self {
        Self { json, status: 0, as_json, tell: Box::new(tell) }
    }

    /// Of a command that has printed everything.
    pub(crate) fn printed(status: i32) -> Self {
        Self { status, ..Self::new(false, Value::Null, || ()) }
    }

    /// With an exit status.
    pub(crate) fn with_status(self, status: i32) -> Self {
        Self { status, ..self }
    }

    /// Prints it and returns the exit status.
    pub(crate) fn print(self) -> Result<i32> {
        if self.as_json {
            println!("{}", serde_json::to_string_pretty(&self.json)?);
        } else {
            (self.tell)();
        }
        Ok(self.status)
    }
}
