//! What measures know of the document that declares them, when it is checked.

use crate::units::Time;
use crate::values::When;

/// A measure as its document declares it. Keys are those of the measure; the key "" is the measure itself.
pub trait Declared {
    /// The path of the measure in the document.
    fn path(&self) -> &str;

    /// Names of the types of cells.
    fn types(&self) -> Vec<&str>;

    /// Number of cells that the run begins with.
    fn cells(&self) -> usize;

    /// Whether cells touch, so that who touches whom is recorded.
    fn has_contacts(&self) -> bool;

    /// Whether it is recorded how cells pull at what they touch.
    fn records_tractions(&self) -> bool;

    /// Whether cells of a type, or of any, have explicit pseudopods.
    fn has_pseudopods(&self, kind: Option<&str>) -> bool;

    /// Notes a fault if a quantity, SYSTEM.QUANTITY, is of a system that is not there.
    fn system_of(&mut self, key: &str, quantity: &str);

    /// Notes a fault at a key.
    fn fault(&mut self, key: &str, label: &str, message: String, help: &str);

    /// Notes a fault if an instant lies outside of the run.
    fn instant(&mut self, key: &str, time: Time);

    /// Notes a fault if a direction is zero.
    fn direction(&mut self, key: &str, direction: [f64; 3]);

    /// Notes a fault if an instant lies outside of the run.
    fn when(&mut self, key: &str, time: When) {
        if let When::At(time) = time {
            self.instant(key, time);
        }
    }

    /// Notes that a key excludes another one.
    fn two_keys(&mut self, key: &str, other: &str, help: &str) {
        let message = format!("`{}` has both `{key}` and `{other}`", self.path());
        self.fault(key, &format!("excluded by `{other}`"), message, help);
    }

    /// Notes a fault if the stretch of time between `from` and `to` is none within the run.
    fn stretch(&mut self, from: Option<Time>, to: Option<Time>) {
        for (key, time) in [("from", from), ("to", to)] {
            if let Some(time) = time {
                self.instant(key, time);
            }
        }
        if let (Some(from), Some(to)) = (from, to)
            && from >= to
        {
            let message = format!("`{}.to` is not after `from`", self.path());
            self.fault("to", "too early", message, "exchange the two");
        }
    }

    /// Whether who touches whom is recorded; a fault if not.
    fn records_contacts(&mut self) -> bool {
        let has_contacts = self.has_contacts();
        if !has_contacts {
            let message = format!("`{}` needs to know who touches whom, and there are no contacts", self.path());
            self.fault("", "not recorded", message, "add [contact] to the document");
        }
        has_contacts
    }
}
