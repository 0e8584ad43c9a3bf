"""Files and pictures of results: CAD files, ParaView results, pictures and the report."""
