"""What acts on the segment, a term each: media, film, contact, friction, bonds, delamination, rig, circuit."""
