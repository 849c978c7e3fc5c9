mod exact;
mod segments;
