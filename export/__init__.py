"""What leaves softdot: CAD files, ParaView results, pictures and the report."""
