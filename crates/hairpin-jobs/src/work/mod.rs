//! From settings to a scenario and the campaign folder it belongs in: begun, gone on with, or looked at.
//!
//! | file | does |
//! | --- | --- |
//! | `settings` | what a campaign is begun with |
//! | `begin` | from settings to a campaign that may begin, and its beginning |
//! | `asked` | what the scenario asks for, and whether that can be answered |
//! | `place` | whether a folder can be made or taken up for it, and doing so |
//! | `open` | a campaign's folder, to be read |
//! | `change` | a campaign's folder, to be gone on with: with which keys changed |
//! | `unchanged` | whether what is in a folder is of the scenario that it has |
//! | `campaign` | what all of them give |

mod asked;
mod begin;
mod campaign;
mod change;
mod open;
mod place;
mod settings;
mod unchanged;

pub(crate) use asked::{saying_what_is_asked, tell_share};
pub(crate) use begin::try_out;
pub use begin::{Planned, plan};
pub use campaign::Work;
pub(crate) use change::{changed, changed_by, check_tables, keep_changes, open_to_change};
pub use open::open_to_read;
pub(crate) use open::{open_as_made, open_to_read_as, open_with};
pub use place::make;
pub(crate) use place::same_place;
pub use settings::{CampaignSettings, IfThere};
pub(crate) use unchanged::{PLACE, no_contradiction, of_another_version, same_as_executed, same_as_made, same_level};
