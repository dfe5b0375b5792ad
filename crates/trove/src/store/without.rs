//! A program that was built without object stores, which says so.

use std::convert::Infallible;
use std::path::PathBuf;

use anyhow::{Result, bail};

use super::Object;

/// No store.
pub(crate) struct Store(Infallible);

/// No answer.
pub(crate) struct Answer(Infallible);

impl Answer {
    pub(crate) fn is_there(&mut self) -> bool {
        match self.0 {}
    }

    pub(crate) fn wait(self) -> Result<()> {
        match self.0 {}
    }
}

impl Store {
    pub(crate) fn open(address: &str) -> Result<Self> {
        bail!(
            "{address}: expected a folder, since this program was built without object stores; build it with \
             --features object-store (docs/cluster.md says how), or give a folder"
        )
    }

    pub(crate) fn address(&self, _: &str) -> String {
        match self.0 {}
    }

    pub(crate) fn put(&self, _: &str, _: Vec<u8>) -> Result<()> {
        match self.0 {}
    }

    pub(crate) fn create(&self, _: &str, _: Vec<u8>) -> Result<bool> {
        match self.0 {}
    }

    pub(crate) fn replace(&self, _: &Object, _: Vec<u8>) -> Result<bool> {
        match self.0 {}
    }

    pub(crate) fn get(&self, _: &str) -> Result<Option<Vec<u8>>> {
        match self.0 {}
    }

    pub(crate) fn look(&self, _: &str) -> Result<Option<Object>> {
        match self.0 {}
    }

    pub(crate) fn list(&self, _: &str) -> Result<Vec<Object>> {
        match self.0 {}
    }

    pub(crate) fn remove(&self, _: &str) -> Result<()> {
        match self.0 {}
    }

    pub(crate) fn send(&self, _: Vec<(String, PathBuf)>) -> Answer {
        match self.0 {}
    }

    pub(crate) fn fetch(&self, _: Vec<(String, PathBuf)>) -> Answer {
        match self.0 {}
    }
}
